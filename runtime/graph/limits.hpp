#pragma once

#include <span>

#include "graph/graph.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

/// Reads `limits`: each holds in every phase that has its block. Numbers stay texts: their unit is the stream's.
void read_limits(const Node& node, std::span<Phase> phases, Report& report);

}  // namespace bodeflow::graph
