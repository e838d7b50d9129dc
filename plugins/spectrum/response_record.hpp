#pragma once

#include <bodeflow/rate.hpp>
#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "distortion.hpp"
#include "estimate.hpp"
#include "records.hpp"

namespace bodeflow::spectrum {

/// What an estimate was made from.
struct Measurement {
  Form form = Form::errors_in_variables;
  Layout layout;
  Rate rate;                            ///< samples per second
  std::int64_t period = 0;              ///< samples
  std::int64_t dropped_samples = 0;     ///< of periods skipped, between experiments, and of a period that was not complete
  double confidence = 0.95;             ///< of the confidence circles
  std::vector<std::string> names;       ///< of inputs, outputs, references
  std::vector<std::string> units;       ///< likewise
  std::vector<double> input_amplitude;  ///< largest |u| of the averaged periods, one an input
  std::vector<std::string> warnings;    ///< what spoils the result, each with what to do

  double line_hz() const { return rate.hz() / static_cast<double>(period); }
};

/// The record `frequency_response` of an estimate; README.md lists its attributes and arrays. `levels`: of the band of the
/// estimate.
RecordBuilder response_record(const Estimate& estimate, const Levels& levels, const Measurement& from);

/// The record `spectral_levels` of the lines of a band.
RecordBuilder levels_record(const Levels& levels, const Estimate& estimate, const Measurement& from);

/// Frequencies of lines [Hz], into `to`: k * rate / period, rounded once.
void fill_frequencies(std::span<double> to, const std::vector<std::int64_t>& lines, const Rate& rate, std::int64_t period);

}  // namespace bodeflow::spectrum
