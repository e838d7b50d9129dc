#include "bodeflow/numerics/confidence.hpp"

#include <cmath>
#include <limits>

namespace bodeflow::numerics {

double confidence_radius(double variance, double degrees_of_freedom, double confidence) {
  const double nu = degrees_of_freedom;
  const double log_outside = -std::log1p(-confidence);
  if (!(nu > 0.0)) return std::numeric_limits<double>::infinity();
  const double quantile = std::isinf(nu) ? log_outside : nu * std::expm1(log_outside / nu);
  return std::sqrt(variance * quantile);
}

}  // namespace bodeflow::numerics
