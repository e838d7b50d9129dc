#pragma once

#include <optional>

#include "graph/graph.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

/// Reads `$phase.block.port.attribute OP value`; `where` ("when", "until") begins messages, `phases` are those that may be
/// named, `current` is the phase in which the condition stands. Nothing: reported.
std::optional<Condition> read_condition(const Node& node, const std::string& where, const std::vector<Phase>& phases,
                                        const std::string& current, Report& report);

}  // namespace bodeflow::graph
