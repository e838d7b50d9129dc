#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::drive {

inline constexpr double kLongestStep = 0.25;  ///< of 1 / (largest decay rate + |omega|)
inline constexpr double kMostParts = 1e5;     ///< of an interval; a motor that needs more has left the range of numbers

/// How many equal Runge-Kutta steps an interval takes for what changes at `rate`: 1 or more; NaN where it would be too many.
inline double runge_kutta_parts(double length, double rate) {
  const double parts = length * rate * (1.0 / kLongestStep);
  if (parts <= 1.0) return 1.0;
  return parts <= kMostParts ? std::ceil(parts) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace bodeflow::drive
