#pragma once

#include <bodeflow/rate.hpp>
#include <bodeflow/record.hpp>
#include <string>

#include "averaging_dft.hpp"

namespace bodeflow::spectrum {

/// What an estimate was made from.
struct Measurement {
  Form form = Form::errors_in_variables;
  Rate rate;                         ///< samples per second
  std::int64_t period = 0;           ///< samples
  std::int64_t dropped_samples = 0;  ///< of periods skipped, and of a period that was not complete
  std::vector<std::string> names;    ///< of the input, then of the outputs
  std::vector<std::string> units;    ///< likewise
};

/// The record `frequency_response` of an estimate; README.md lists its attributes and arrays.
RecordBuilder response_record(const Estimate& estimate, const Measurement& from);

/// The unit of a ratio: "rad/A"; "rad" and "1/A" where one of them is without unit, "1" where they are equal.
std::string ratio_unit(const std::string& above, const std::string& below);

}  // namespace bodeflow::spectrum
