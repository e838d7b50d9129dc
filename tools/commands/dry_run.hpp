#pragma once

#include "commands/command.hpp"
#include "phases/prepare.hpp"

namespace bodeflow::tools {

/// Prints the plan, and what would move: devices, their signals, limits, and what the graph puts on them. No device is opened.
int dry_run(const GraphOptions& options, const graph::Graph& graph, Registry& registry, const phases::PlanSettings& settings);

}  // namespace bodeflow::tools
