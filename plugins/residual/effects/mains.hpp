#pragma once

#include <algorithm>
#include <bodeflow/effect.hpp>
#include <cmath>

/// Which tones are the mains.
namespace bodeflow::residual {

/// The frequency of the mains that a tone at f belongs to as first or third harmonic; 0 where to none. Mains stay within 1 % of
/// 50 or 60 Hz even in a disturbed network (EN 50160).
inline double mains_of(double f) {
  for (const double order : {1.0, 3.0}) {
    for (const double mains : {50.0, 60.0}) {
      if (std::abs(f / order - mains) <= 0.01 * mains) return f / order;
    }
  }
  return 0.0;
}

/// The frequencies of mains that tones between the lines point to, highest tone first, each once.
inline std::vector<double> mains_peaks(const Situation& s) {
  std::vector<double> mains;
  for (const double peak : s.peaks_hz) {
    const double f = mains_of(peak);
    const bool known = std::any_of(mains.begin(), mains.end(), [&](double m) { return std::abs(m - f) * s.duration_s < 0.5; });
    if (f > 0.0 && !known) mains.push_back(f);
  }
  return mains;
}

}  // namespace bodeflow::residual
