#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/rate.hpp>
#include <cstdint>
#include <vector>

/// Frequencies of a stepped sine, placed so that they fit the samples.
namespace bodeflow::generators {

/// A frequency of `cycles` whole cycles in a window of `window` samples.
struct FrequencyStep {
  double wanted_hz = 0.0;
  std::int64_t cycles = 0;  ///< m
  std::int64_t window = 0;  ///< N, above 2 m; m and N have no common factor

  /// m rate / N, the frequency really used.
  double frequency_hz(Rate rate) const;
};

/// The windows are not longer than this: a correlator keeps one.
inline constexpr std::int64_t kLongestWindow = 100'000'000;

/// The fewest cycles whose whole number of samples, rounded to nearest, gives `wanted_hz` within `tolerance` (relative).
/// Rounding moves a window of N samples by at most 1 / (2 N), so it stays below 1 / (2 tolerance) samples plus one cycle, but
/// next to half of the rate. Errors: a frequency that is not above 0 and below half of the rate once it is placed; a window
/// beyond kLongestWindow. tolerance > 0.
Expected<FrequencyStep> place_frequency(double wanted_hz, Rate rate, double tolerance);

/// Each frequency placed. Errors: those of place_frequency; two that fall on the same frequency.
Expected<std::vector<FrequencyStep>> place_frequencies(const std::vector<double>& wanted_hz, Rate rate, double tolerance);

/// `count` frequencies from first to last, evenly spaced, or with a constant ratio where `logarithmic`. count >= 1; only `first`
/// for 1.
std::vector<double> frequency_grid(double first_hz, double last_hz, std::int64_t count, bool logarithmic);

}  // namespace bodeflow::generators
