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
  double order = 0.0;   ///< within the layer
  double middle = 0.0;  ///< across the layers; the least border of all is 0
  double size = 0.0;    ///< across the layers
};

/// A drawing in layers: edges without loops lead from layer to layer, neighbours lie beside each other.
/// Method: Sugiyama, Tagawa & Toda, IEEE Trans. SMC 11, 1981: loops broken at the edge that closes them, longest path for the
/// layers, barycentres for the order.
struct GraphLayout {
  std::vector<LayoutNode> nodes;
  std::vector<LayoutEdge> edges;
  int layers = 0;
};

/// `sizes`: of each box across the layers; `gap`: between neighbours in a layer.
GraphLayout layout_graph(const std::vector<double>& sizes, std::vector<LayoutEdge> edges, double gap);

}  // namespace bodeflow::tools::report
