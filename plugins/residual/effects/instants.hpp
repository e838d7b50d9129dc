#pragma once

#include <algorithm>
#include <bodeflow/effect.hpp>

#include "effects/words.hpp"

/// When something changed: for effects that jump once.
namespace bodeflow::residual {

/// Instants from which a fit sets out: where the residual changes most, else the thirds of the record.
inline std::vector<double> likely_instants(const Situation& s) {
  constexpr std::size_t kMost = 3;
  if (s.jumps_s.empty()) return {s.duration_s / 3.0, 2.0 * s.duration_s / 3.0};
  return {s.jumps_s.begin(), s.jumps_s.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, s.jumps_s.size()))};
}

/// 0 before the instant and 1 after it, straight within half a step of it: so that the fit can move the instant.
inline double after(double instant_s, double time_s, double step_s) {
  if (!(step_s > 0.0)) return time_s >= instant_s ? 1.0 : 0.0;
  return std::clamp((time_s - instant_s) / step_s + 0.5, 0.0, 1.0);
}

/// The parameter that such effects share.
inline FitParameter instant(const Situation& s) {
  return real("instant", "s", size_or_one(s.duration_s / 10.0))
      .between(0.0, s.duration_s)
      .says("when it jumps, since the record began");
}

}  // namespace bodeflow::residual
