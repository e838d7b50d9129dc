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
/// `class_before`, `class_after` (multiples of the noise) and `class_p_before`, `class_p_after`: `class_records` x `class_names`,
/// the records that are judged; `test_class_before` ... the same of the test record, which is told alone. `noise_floor_99.9` and
/// `noise_floor_0.01`: noise alone leaves more with a probability of 0.1 %, and less with 0.01 %, the latter with the model that
/// is told. Errors by record and views of the residual: record_views.hpp.
RecordBuilder write_trace(const Trace& trace, const TraceData& data, const Declared& declared);

}  // namespace bodeflow::residual
