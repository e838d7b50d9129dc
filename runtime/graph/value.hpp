#pragma once

#include <optional>
#include <string>

#include "graph/node.hpp"
#include "plugins/description.hpp"

namespace bodeflow::graph {

/// The value of a parameter, checked against type, unit, choices and range; nothing: reported as "where: reason".
/// Paths become absolute, in the node too. `own_unit`: that of the block's numbers, "" for none; a quantity of its dimension
/// counts in it where the parameter has no unit of its own, and in SI units otherwise.
std::optional<ParameterValue> read_parameter(Node& node, const ParameterDescription& description, const std::string& where,
                                             Report& report, const std::string& own_unit = "");

/// "a number [Hz]", "a list of whole numbers": what may be written.
std::string allowed_form(const ParameterDescription& description);

/// "at least 1", "above 0 and at most 10", "" for a parameter without range.
std::string range_text(const ParameterDescription& description);

}  // namespace bodeflow::graph
