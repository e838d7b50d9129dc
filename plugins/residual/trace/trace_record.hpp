#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "trace/trace.hpp"

namespace bodeflow::residual {

/// What was declared for a trace, so that a later block can build the model again.
struct Declared {
  std::string base;                       ///< id
  std::vector<std::string> declarations;  ///< "name=value"
  std::vector<std::string> notes;         ///< how the records were prepared
};

/// The record `trace`: verdict, effects and errors as scripts rely on them; parameters before and after, the class tests and the
/// residual pictures of the test record, and every candidate of every step with what it gained and why it was not taken.
RecordBuilder write_trace(const Trace& trace, const TraceData& data, const Declared& declared);

}  // namespace bodeflow::residual
