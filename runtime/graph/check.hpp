#pragma once

#include "graph/graph.hpp"
#include "graph/node.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::graph {

/// Makes the graph of a whole document (includes, variables and overrides are done). The graph is good when the report stays
/// empty; paths in the document become absolute.
Graph check(Node& root, const Registry& registry, Report& report);

}  // namespace bodeflow::graph
