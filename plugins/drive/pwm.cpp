#include "pwm.hpp"

#include <algorithm>

namespace bodeflow::drive {
namespace {

double sign(double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }

/// Shortest pulse and gap of a leg, as a share of the period.
double margin(const Modulation& m) { return 2.0 * m.dead_time_s / m.period_s; }

double zero_sequence(const std::array<double, 3>& v) {
  const auto [low, high] = std::minmax({v[0], v[1], v[2]});
  return -0.5 * (low + high);
}

}  // namespace

Switching switching(const Modulation& m, AlphaBeta reference, AlphaBeta current, AlphaBeta measured) {
  const std::array<double, 3> wanted = phases(reference), flowing = phases(current), known = phases(measured);
  const double shift = m.min_max ? zero_sequence(wanted) : 0.0;
  const double least = margin(m);
  Switching s;
  std::array<double, 3> mean{};
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double asked = 0.5 + (wanted[leg] + shift) / m.dc_link_v;
    s.limited = s.limited || asked < least || asked > 1.0 - least;
    const double duty = std::clamp(asked + sign(known[leg]) * m.compensation_time_s / m.period_s, least, 1.0 - least);
    Pulse& pulse = s.legs[leg];
    pulse.on = 0.5 * (1.0 - duty) * m.period_s + (flowing[leg] > 0.0 ? m.dead_time_s : 0.0);
    pulse.off = std::min(m.period_s, 0.5 * (1.0 + duty) * m.period_s + (flowing[leg] < 0.0 ? m.dead_time_s : 0.0));
    mean[leg] = (pulse.off - pulse.on) / m.period_s * m.dc_link_v;
  }
  s.mean_voltage = clarke(mean[0], mean[1], mean[2]);
  return s;
}

double linear_range(const Modulation& m) {
  const double half = (0.5 - margin(m)) * m.dc_link_v;
  return m.min_max ? 2.0 / kSqrt3 * half : half;
}

}  // namespace bodeflow::drive
