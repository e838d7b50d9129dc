#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace bodeflow::residual {

/// When the output is sampled: sample n shows the plant `offset_s` after sample time n - late of the input begins.
struct SampleDelay {
  Eigen::Index late = 0;
  double offset_s = 0.0;  ///< in [0, sample time)
};

/// Of a delay of any sign. A quotient within 1e-9 of a whole number counts as whole.
inline SampleDelay sample_delay(double delay_s, double sample_time_s) {
  const double quotient = delay_s / sample_time_s, nearest = std::round(quotient);
  if (std::abs(quotient - nearest) <= 1e-9 * std::max(1.0, std::abs(nearest))) return {static_cast<Eigen::Index>(nearest), 0.0};
  const double late = std::ceil(quotient);
  return {static_cast<Eigen::Index>(late), (late - quotient) * sample_time_s};
}

}  // namespace bodeflow::residual
