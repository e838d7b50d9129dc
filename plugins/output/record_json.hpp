#pragma once

#include <bodeflow/record.hpp>
#include <string>

namespace bodeflow::output {

/// One line of JSON, without a line end: {"time": s, "type": ..., "attributes": {...}, "arrays": {name: {"unit", "shape",
/// "data"}}}. Data is flat and row-major, complex numbers are [re, im], values that are not finite null; numbers have the
/// shortest digits that read back as the same value.
std::string to_json_line(const RecordView& record, double time_s);

}  // namespace bodeflow::output
