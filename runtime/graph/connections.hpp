#pragma once

#include "graph/ends.hpp"
#include "graph/graph.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

/// Reads `connections` (nullptr: none) into the phase's streams, messages and references, and reports inputs that lack one.
/// `earlier`: the phases that references may name.
void read_connections(const Node* node, const std::vector<Phase>& earlier, const BlockIndex& blocks, Phase& phase,
                      Report& report);

}  // namespace bodeflow::graph
