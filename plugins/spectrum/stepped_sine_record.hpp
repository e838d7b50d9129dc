#pragma once

#include <bodeflow/rate.hpp>
#include <bodeflow/record.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "records.hpp"
#include "sine_response.hpp"

namespace bodeflow::spectrum {

/// What was measured at one frequency.
struct SteppedLine {
  double frequency_hz = 0.0;
  std::int64_t cycles = 0;
  std::int64_t window = 0;  ///< samples
  bool settled = false;
  double settled_after_s = 0.0;
  double dwell_s = 0.0;
  SineResponse response;
};

/// What the lines were made from.
struct SteppedMeasurement {
  Rate rate;
  Signals input, outputs;
  std::int64_t planned = 0;  ///< frequencies that the generator announced
};

/// What spoils these lines, and what to do about it: answers that never settled; fewer than 4 windows; an input, an output within
/// 10 dB of its own noise; frequencies that are missing at the end.
std::vector<std::string> stepped_warnings(const std::vector<SteppedLine>& lines, const SteppedMeasurement& from);

/// The record `frequency_response` of form stepped_sine, lines in rising order; README.md lists its arrays. `degrees_of_freedom`
/// are those of the line with the fewest; each confidence radius has its own line's.
RecordBuilder stepped_record(std::vector<SteppedLine> lines, const SteppedMeasurement& from);

}  // namespace bodeflow::spectrum
