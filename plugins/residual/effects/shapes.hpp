#pragma once

#include <algorithm>
#include <cmath>

/// Functions that laws are made of, with their slopes.
namespace bodeflow::residual {

struct Shape {
  double value = 0.0;
  double slope = 0.0;
};

/// The sign of x, straight within +-width.
inline Shape spread_sign(double x, double width) {
  if (std::abs(x) >= width) return {x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0), 0.0};
  return {x / width, 1.0 / width};
}

/// What of x lies beyond +-gap.
inline Shape beyond_gap(double x, double gap) {
  if (std::abs(x) <= gap) return {};
  return {x > 0.0 ? x - gap : x + gap, 1.0};
}

/// The play operator: what follows x with a clearance of +-gap and stood at `before`.
inline double with_play(double before, double x, double gap) { return std::min(std::max(before, x - gap), x + gap); }

}  // namespace bodeflow::residual
