#pragma once

#include "graph/graph.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

inline constexpr std::int64_t kMostSweepValues = 1'000'000;

/// Reads `sweep` into phase.sweep and checks that every value fits what it is for. A path is `seed`, `block.parameter` or
/// `run.key`: behind `phase.` it is the path of a --set.
void read_sweep(Node& node, Phase& phase, Report& report);

}  // namespace bodeflow::graph
