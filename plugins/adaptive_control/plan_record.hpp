#pragma once

#include <bodeflow/record.hpp>
#include <vector>

namespace bodeflow::adaptive_control {

/// What a start-up experiment found out for the adaptive loop: record `adaptive_plan`.
struct Plan {
  std::vector<double> omega;  ///< frequencies of fitting [rad/s]
  int delay = 0;              ///< d of the estimators, samples
  double bandwidth = 0.0;     ///< w_m [rad/s]
  double desired_delay_s = 0.0;
  double start_gain = 0.0;
};

/// Errors, as failures of the block: another type, attributes that are absent or out of range, another number of frequencies than
/// `points`.
Plan read_plan(const RecordView& record, std::size_t points);

RecordBuilder write_plan(const Plan& plan);

}  // namespace bodeflow::adaptive_control
