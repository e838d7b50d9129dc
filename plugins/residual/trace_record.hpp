#pragma once

#include <bodeflow/record.hpp>

#include "trace.hpp"

namespace bodeflow::residual {

/// The record `trace`: verdict, effects and errors as scripts rely on them; parameters before and after, the class tests and the
/// residual spectra of the test record, and every candidate with what it gained and why it was not taken.
RecordBuilder write_trace(const Trace& trace, const TraceData& data, const BaseModel& base);

}  // namespace bodeflow::residual
