#pragma once

#include <cstddef>
#include <vector>

namespace bodeflow::tools::report {

struct LayoutEdge {
  int from = 0;
  int to = 0;
  bool backward = false;  ///< filled in: closes a loop
  std::vector<int> by;    ///< filled in: the nodes on its way from layer to layer, its ends included
};

/// A box, or a bend of an edge that crosses a layer (index from the number of boxes on).
struct LayoutNode {
  int layer = 0;
  double order = 0.0;  ///< within the layer
  double y = 0.0;      ///< of its middle
  double height = 0.0;
};

/// A drawing in layers from left to right: edges without loops lead to the right, neighbours lie at like heights.
/// Method: Sugiyama, Tagawa & Toda, IEEE Trans. SMC 11, 1981: loops broken at the edge that closes them, longest path for the
/// layers, barycentres for the order.
struct GraphLayout {
  std::vector<LayoutNode> nodes;
  std::vector<LayoutEdge> edges;
  int layers = 0;
};

GraphLayout layout_graph(std::size_t boxes, std::vector<LayoutEdge> edges, double box_height, double gap);

}  // namespace bodeflow::tools::report
