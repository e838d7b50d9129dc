#pragma once

#include <bodeflow/error.hpp>
#include <cstdint>
#include <vector>

namespace bodeflow::spectrum {

/// First and last line of a range.
struct LineRange {
  std::int64_t first = 1;
  std::int64_t last = 1;
  std::int64_t count() const { return last - first + 1; }
};

/// The lines k, at k/samples times the rate, that lie in the band [from, to] in Hz, both ends included; all between zero and the
/// Nyquist frequency for an empty band. Errors: a band that is not two rising numbers, that is not above zero and below the
/// Nyquist frequency, or that holds no line.
Expected<LineRange> lines_in_band(const std::vector<double>& band_hz, double sample_rate_hz, std::int64_t samples);

}  // namespace bodeflow::spectrum
