#pragma once

#include <utility>
#include <vector>

namespace bodeflow::plan {

/// A directed edge between nodes that count from zero.
using Arc = std::pair<int, int>;

/// The nodes in an order in which every arc points forward, the smallest index first among those that are free. Nodes on a
/// cycle, and what depends on them, are missing at the end: the result is shorter than `nodes`.
std::vector<int> topological_order(int nodes, const std::vector<Arc>& arcs);

/// Nodes that reach each other; one node alone is a loop if it has an arc to itself.
struct Component {
  std::vector<int> nodes;  ///< ascending
  bool loop = false;
};

/// The strongly connected components in topological order; among those that are free the one with the smallest node first.
std::vector<Component> ordered_components(int nodes, const std::vector<Arc>& arcs);

}  // namespace bodeflow::plan
