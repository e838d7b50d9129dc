#pragma once

#include "graph/ends.hpp"
#include "graph/graph.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

/// Reads `schedule` into phase.schedule, ordered by time, then as written. Values become part of the document's tree.
void read_schedule(Node& node, const BlockIndex& blocks, Phase& phase, Report& report);

/// Reads `record` into phase.recorded: stream outputs. Message outputs may be named, they are kept always.
void read_record(const Node& node, const BlockIndex& blocks, Phase& phase, Report& report);

/// Reads `hosts` into Block::host of all phases.
void read_hosts(const Node& node, std::vector<Phase>& phases, Report& report);

/// Reads `summary`: names of results, each one that a block of the phases gives, and what to type next.
Summary read_summary(const Node& node, const std::vector<Phase>& phases, Report& report);

}  // namespace bodeflow::graph
