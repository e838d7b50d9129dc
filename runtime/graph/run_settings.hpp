#pragma once

#include "graph/graph.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

/// Reads a `run` map over the settings that hold so far (the defaults, or those of the whole graph).
void read_run(const Node& node, RunSettings& run, Report& report);

/// A seed of random numbers; nothing: reported.
std::optional<std::uint64_t> read_seed(const Node& node, const std::string& where, Report& report);

}  // namespace bodeflow::graph
