#pragma once

#include "generate/drive.hpp"

namespace battery::test {

/// A drive with a given seed at level 1.
inline Drive drive_for(const std::vector<int>& lines, double sample_time, double rms, const char* seed = "test") {
  Random random(seed);
  return make_drive(lines, 2048, sample_time, rms, 1.0, random);
}

/// An input that is constant.
inline Drive constant_drive(double value, double sample_time) {
  Drive d;
  d.period = 2048;
  d.sample_time = sample_time;
  d.half_steps.assign(d.period * 2 * kSubsteps, value);
  return d;
}

/// Coefficients of the last period of a record.
inline std::vector<Complex> last_period(const Drive& d, const Series& y) {
  return coefficients(Series(y.end() - static_cast<std::ptrdiff_t>(d.period), y.end()), d.lines);
}

}  // namespace battery::test
