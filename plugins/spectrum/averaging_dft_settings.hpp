#pragma once

#include <bodeflow/block.hpp>

#include "estimate.hpp"
#include "experiment_schedule.hpp"

namespace bodeflow::spectrum {

/// The parameters of spectrum.averaging_dft, checked against each other.
struct AveragingDftSettings {
  Schedule schedule;  ///< experiments: 0 where they follow from the number of inputs
  Form form = Form::errors_in_variables;
  LineChoice choice;
  std::int64_t every = 0;
  double confidence = 0.95;
  double outliers = 0.0;  ///< 0: all periods are averaged
  bool detrend = false;
  bool remove_transient = false;
};

/// Describes the parameters.
void describe_averaging_dft_settings(Describe& d);

/// The settings that `p` gives; fails with what contradicts what.
AveragingDftSettings averaging_dft_settings(const Parameters& p);

/// The parameter `period`, in its range.
std::int64_t period_of(const Parameters& p);

/// Describes the parameters of a choice of lines, and reads it for a period of N samples.
void describe_lines(Describe& d);
LineChoice line_choice(const Parameters& p, std::int64_t period);

}  // namespace bodeflow::spectrum
