#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "signals.hpp"

namespace bodeflow::records {

/// The samples of one experiment.
struct Recording {
  double sample_rate_hz = 0.0;
  std::int64_t period = 0;   ///< samples; 0: not periodic
  std::int64_t skip = 0;     ///< periods at the start that hold the transient
  std::int64_t periods = 0;  ///< whole periods after them; 0 where not periodic
  Signals input_signals;
  Signals output_signals;
  Eigen::MatrixXd input;   ///< samples x channels, the skipped periods included
  Eigen::MatrixXd output;  ///< samples x channels
  /// Lines of the excitation (multiples of rate / period) and their peak amplitudes, where it states them; else empty.
  std::vector<std::int64_t> excited_lines;
  std::vector<double> excited_amplitudes;

  Eigen::Index samples() const { return input.rows(); }
};

/// What a record `recording` holds. Errors, by name: another type, arrays that are absent or do not fit each other or the
/// attributes, values that are not finite (with signal and sample).
Expected<Recording> read_recording(const RecordView& record);

/// The record `recording`.
RecordBuilder write_recording(const Recording& recording);

}  // namespace bodeflow::records
