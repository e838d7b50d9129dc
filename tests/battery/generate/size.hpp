#pragma once

#include <vector>

#include "generate/hidden.hpp"

namespace battery {

/// Root mean square, over the steady periods of records without noise, of what the plant's own model leaves when its parameters
/// are fitted anew (least squares at the excited lines). So what the base model can take up does not count as an effect.
double model_error(const Plant& plant, const std::vector<Drive>& drives, const std::vector<Series>& outputs);

struct Sized {
  double strength = 0.0;
  double error = 0.0;  ///< the model error reached
};

/// The strength at which `error(strength)` is near the wanted one: within 5 %, or at the largest strength.
template <class Error>
Sized strength_for(double wanted, double first, double largest, Error&& error);

}  // namespace battery

#include <algorithm>
#include <cmath>

namespace battery {

template <class Error>
Sized strength_for(double wanted, double first, double largest, Error&& error) {
  constexpr int kTries = 12;
  constexpr double kNear = 0.05, kLargestStep = 5.0;
  Sized at{first, error(first)}, below{0.0, 0.0}, above{largest, INFINITY};
  double slope = 1.0;  // of log error over log strength
  for (int n = 0; n < kTries && !(std::abs(at.error / wanted - 1.0) < kNear); ++n) {
    const bool too_small = at.error < wanted;  // a simulation that ran away is too strong
    if (too_small && at.strength >= largest) break;
    (too_small ? below : above) = at;
    double step = std::isfinite(at.error) && at.error > 0.0 ? std::pow(wanted / at.error, 1.0 / slope)
                                                            : (too_small ? kLargestStep : 1.0 / kLargestStep);
    double next = std::min(at.strength * std::clamp(step, 1.0 / kLargestStep, kLargestStep), largest);
    if (next <= below.strength || next > above.strength || (next == above.strength && std::isfinite(above.error))) {
      next = below.strength > 0.0 ? std::sqrt(below.strength * above.strength) : 0.5 * above.strength;
    }
    const Sized then{next, error(next)};
    const double rise = std::log(then.error / at.error) / std::log(then.strength / at.strength);
    if (std::isfinite(rise)) slope = std::clamp(rise, 0.3, 8.0);
    at = then;
  }
  return at;
}

}  // namespace battery
