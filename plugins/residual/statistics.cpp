#include "statistics.hpp"

#include <bodeflow/numerics/chi_squared.hpp>
#include <bodeflow/numerics/random.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

namespace bodeflow::residual {
namespace {

// Beyond as many degrees of freedom of the lower mean square its spread is below all that is told here.
constexpr double kKnown = 1e9;

}  // namespace

double f_tail(double value, double d1, double d2) {
  if (!(value > 0.0)) return 1.0;
  if (std::isinf(value)) return 0.0;
  if (!(d2 < kKnown)) return numerics::chi_squared_tail(value * d1, d1);
  return boost::math::ibeta(d2 / 2.0, d1 / 2.0, d2 / (d2 + d1 * value));
}

double f_limit(double probability, double d1, double d2) {
  if (!(d2 < kKnown)) return numerics::chi_squared_limit(probability, d1) / d1;
  const double x = boost::math::ibeta_inv(d2 / 2.0, d1 / 2.0, probability);
  return d2 * (1.0 - x) / (d1 * x);
}

double normal_limit(double probability) { return -numerics::normal_quantile(probability); }

}  // namespace bodeflow::residual
