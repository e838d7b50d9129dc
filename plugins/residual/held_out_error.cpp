#include "held_out_error.hpp"

#include <algorithm>
#include <cmath>

#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kHighest = 1e-3;
constexpr double kLeak = 1e-4;

}  // namespace

double HeldOutError::excess() const { return std::sqrt(std::max(error * error - floor * floor, 0.0)); }

HeldOutError held_out_error(const Experiment& e, const Eigen::VectorXcd& predicted) {
  double square = 0.0, mean = 0.0, spread = 0.0;
  for (Eigen::Index k = 0; k < e.lines(); ++k) {
    const double weight = k == 0 ? 1.0 : 2.0, freedom = k == 0 ? 1.0 : 2.0, own = weight * e.variance[k];
    square += weight * std::norm(e.output[k] - predicted[k]);
    mean += own;
    spread += 2.0 * own * own / freedom;
  }
  const double d1 = 2.0 * mean * mean / spread, d2 = 2.0 / e.floor.relative_variance(e.frequency_hz);
  HeldOutError h;
  h.error = std::sqrt(square);
  h.floor = std::sqrt(mean);
  h.highest = h.floor * std::sqrt(f_limit(kHighest, d1, d2));
  h.lowest = h.floor * std::sqrt(f_limit(1.0 - kLeak, d1, d2));
  return h;
}

}  // namespace bodeflow::residual
