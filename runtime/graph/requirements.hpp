#pragma once

#include <optional>
#include <string_view>

#include "graph/node.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::graph {

/// Checks `requires: {family: ">=1.2"}` against the plugins that are there. A requirement is a list of comparisons
/// (>=, >, <=, <, ==) with commas between them; a version alone means >=.
void check_requirements(const Node& node, const Registry& registry, Report& report);

/// -1, 0 or 1: order of two versions, number by number ("1.10" is above "1.9"); nothing when one is no version.
std::optional<int> compare_versions(std::string_view a, std::string_view b);

}  // namespace bodeflow::graph
