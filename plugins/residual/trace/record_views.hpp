#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "trace/trace.hpp"

namespace bodeflow::residual {

/// Adds the error of every record (`record_error_before`, `record_error_after`, `record_noise`, in the order of `records`), and
/// where the floor is known its classes in the unit of the output (`class_rms_before`, `class_rms_after`, `class_rms_noise`,
/// records x classes). Not a number where a record lacks the class.
void put_sizes(RecordBuilder& record, const Trace& trace, const TraceData& data, const std::vector<std::string>& classes);

/// Adds what is drawn of the test record's residual beside its spectrum or course; nothing for a response.
///   `map_signals`, `map_units`: over what, signals that are straight lines of an earlier one left out; `map_at`, `map_before`,
///   `map_before_std`, `map_after`, `map_after_std`, signals x 24:
///     mean of the signal in a bin, mean of the residual there and its standard error; not a number beyond the bins of a signal
///   `course_axis` "period" or "time", `course_at`, `course_before`, `course_after`: root mean square; `course_noise`: of the
///     noise alone, not a number where it is not known
///   `autocorrelation_lag`, `autocorrelation_before`, `autocorrelation_after`; `autocorrelation_band`: white noise stays within
///     it with 95 %
void put_views(RecordBuilder& record, const Trace& trace, const Measurement& test);

}  // namespace bodeflow::residual
