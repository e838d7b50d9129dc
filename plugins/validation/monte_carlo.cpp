#include "monte_carlo.hpp"

#include <cmath>

namespace bodeflow::validation {
namespace {

constexpr double kNormal95 = 1.959963984540054;  ///< quantile 0.975 of the standard normal distribution

}  // namespace

Spread spread(const Eigen::VectorXd& values) {
  const double mean = values.mean();
  const double squares = (values.array() - mean).square().sum();
  return {mean, std::sqrt(squares / static_cast<double>(values.size() - 1))};
}

double coverage(const Eigen::VectorXd& values, const Eigen::VectorXd& deviation, double truth) {
  Eigen::Index inside = 0;
  for (Eigen::Index r = 0; r < values.size(); ++r)
    if (std::abs(values[r] - truth) <= kNormal95 * deviation[r]) ++inside;
  return static_cast<double>(inside) / static_cast<double>(values.size());
}

}  // namespace bodeflow::validation
