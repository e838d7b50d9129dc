#pragma once

#include <string>

#include "graph/node.hpp"

namespace bodeflow::graph {

/// The document as YAML text: what is written with brackets stays so where it is short, the order stays, comments do not.
/// Reading it gives the same tree.
std::string to_yaml(const Node& root);

/// One node as a flow text, as a --set takes it.
std::string flow_text(const Node& node);

}  // namespace bodeflow::graph
