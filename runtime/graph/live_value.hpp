#pragma once

#include <string>
#include <tl/expected.hpp>

#include "plugins/description.hpp"

namespace bodeflow::graph {

/// The value of a parameter from a text as people type it, checked for type, unit, choices and range as in a graph file ("2 kHz",
/// "[1, 2]"); `own_unit` as for `read_parameter`. Error, in a line: "where: what was found, what is allowed".
tl::expected<ParameterValue, std::string> read_live_value(const ParameterDescription& description, const std::string& where,
                                                          const std::string& text, const std::string& own_unit);

}  // namespace bodeflow::graph
