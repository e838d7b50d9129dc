#pragma once

#include <bodeflow/error.hpp>
#include <string>

namespace bodeflow::records {

/// A band of angular frequencies.
struct Band {
  double low_rad_s = 0.0;
  double high_rad_s = 0.0;
};

/// The band that a text names: two ends with a colon between, `1 Hz:50 Hz`, `1:50 Hz`, `10:300 rad/s`; bare numbers are in
/// rad/sample and need a sample rate: `0:0.625`. An end may be left open: `:50 Hz`, `10 Hz:`, with the first at 0 and the last at
/// half the sample rate. An empty text is the whole range. sample_rate_hz: 0 where there is none; then both ends need units, and
/// an open end is infinite.
/// Errors, with the text: more or fewer than one colon, no number, another unit, ends that do not rise, an end above half the
/// sample rate.
Expected<Band> parse_band(const std::string& text, double sample_rate_hz);

}  // namespace bodeflow::records
