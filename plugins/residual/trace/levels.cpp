#include "trace/levels.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>

#include "statistics.hpp"

namespace bodeflow::residual {

double Levels::p_class() const { return alpha / 2.0 / static_cast<double>(std::max<std::size_t>(class_tests, 1)); }
double Levels::p_candidate() const { return alpha / 2.0 / static_cast<double>(std::max<std::size_t>(candidates, 1)); }
double Levels::z_candidate() const { return normal_limit(p_candidate()); }
double Levels::z_block() const { return normal_limit(alpha / 2.0); }

double held_out_p(double gain, double fitted) {
  if (!(gain > 0.0)) return 1.0;
  const double without = fitted > 0.0 ? numerics::chi_squared_tail(gain, fitted) : 0.0;
  return 0.5 * (without + numerics::chi_squared_tail(gain, fitted + 1.0));
}

}  // namespace bodeflow::residual
