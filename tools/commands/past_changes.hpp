#pragma once

#include "graph/graph.hpp"
#include "phases/run.hpp"

namespace bodeflow::tools {

/// The changes that people made by hand while the run in `directory` went on, from its events, for a repetition of the same
/// graph. Error: events.jsonl is damaged, or tells of a change that the graph does not allow.
tl::expected<std::vector<phases::PastChanges>, std::string> read_past_changes(const std::filesystem::path& directory,
                                                                              const graph::Graph& graph);

}  // namespace bodeflow::tools
