#pragma once

#include <string>
#include <vector>

#include "graph/node.hpp"

namespace bodeflow::graph {

using Names = std::vector<std::string>;

/// The version of the format: `bodeflow: 1`.
inline constexpr int kFormat = 1;

const Names& graph_keys();  ///< at the top of a file
const Names& phase_keys();
const Names& run_keys();
const Names& limit_keys();
const Names& violation_actions();  ///< clamp, stop, warn
const Names& clocks();
const Names& overruns();

/// Reports the keys of a map that are not allowed; `where` ("run: ", or "") begins the message.
void check_keys(const Node& map, const std::string& where, const Names& allowed, Report& report);

/// True for a map; otherwise reports what it is, silent about a node that is broken.
bool require_map(const Node& node, const std::string& where, const std::string& allowed, Report& report);
bool require_list(const Node& node, const std::string& where, const std::string& allowed, Report& report);

}  // namespace bodeflow::graph
