#pragma once

#include <bodeflow/record.hpp>
#include <optional>

#include "records/response.hpp"

namespace bodeflow::validation {

/// The frequencies at which models are evaluated; absent ends come from the models.
struct FrequencyGrid {
  std::optional<double> first_hz, last_hz;
  Eigen::Index count = 200;
  bool logarithmic = false;
};

/// The mean of the runs' frequency responses with the variance E|dG|^2 of one run over the runs, or nothing where the sweep's
/// runs have none that can be laid over each other.
///
/// Runs with `response` and the same `frequency` are averaged as they are. Runs of one input and output with `numerator` and
/// `denominator` (and `sample_time`, `delay`) are evaluated over the grid; without ends it covers a discrete-time model up to
/// half its sample rate, and a continuous one gives nothing.
/// Errors: grid ends that do not rise, or lie beyond half the sample rate.
Expected<std::optional<records::ResponseData>> run_responses(const RecordView& sweep, const FrequencyGrid& grid);

}  // namespace bodeflow::validation
