#pragma once

#include <bodeflow/record_view.hpp>
#include <string>
#include <tl/expected.hpp>

#include "plugins/description.hpp"

namespace bodeflow::execute {

struct ParameterChange {
  int parameter = 0;  ///< index into BlockDescription::parameters
  ParameterValue value;
};

/// What a `parameter_change` record {parameter: text, value} asks of a block of that type. The value is an attribute (lists for
/// lists), or an array of that name: f64 of rank 1 or 2, i64 of rank 1, c64 of rank 1. Numbers count in the parameter's unit.
/// Errors: another record type, an unknown parameter or one that is not live, a wrong type, a value out of range or no choice.
tl::expected<ParameterChange, std::string> parameter_change(const BlockDescription& type, const RecordView& record);

}  // namespace bodeflow::execute
