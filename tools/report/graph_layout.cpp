#include "report/graph_layout.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bodeflow::tools::report {
namespace {

constexpr int kSweeps = 8;       ///< of the order in the layers
constexpr int kSettlings = 100;  ///< of the places
constexpr double kBendSize = 14.0;

/// Marks the edges that lead back to a box on the current path.
void mark_backward(std::size_t boxes, std::vector<LayoutEdge>& edges) {
  std::vector<int> state(boxes, 0);  // 1: on the path, 2: done
  const std::function<void(int)> visit = [&](int box) {
    state[static_cast<std::size_t>(box)] = 1;
    for (auto& edge : edges) {
      if (edge.from != box) continue;
      int& next = state[static_cast<std::size_t>(edge.to)];
      if (next == 1) edge.backward = true;
      if (next == 0) visit(edge.to);
    }
    state[static_cast<std::size_t>(box)] = 2;
  };
  for (std::size_t box = 0; box < boxes; ++box)
    if (state[box] == 0) visit(static_cast<int>(box));
}

void place_in_layers(GraphLayout& layout, std::size_t boxes) {
  for (std::size_t round = 0; round < boxes; ++round)
    for (const auto& edge : layout.edges) {
      if (edge.backward) continue;
      int& layer = layout.nodes[static_cast<std::size_t>(edge.to)].layer;
      layer = std::max(layer, layout.nodes[static_cast<std::size_t>(edge.from)].layer + 1);
    }
  // A source stands next to what it feeds
  for (std::size_t box = 0; box < boxes; ++box) {
    int nearest = -1;
    bool fed = false;
    for (const auto& edge : layout.edges) {
      if (edge.backward) continue;
      fed |= edge.to == static_cast<int>(box);
      const int layer = layout.nodes[static_cast<std::size_t>(edge.to)].layer;
      if (edge.from == static_cast<int>(box) && (nearest < 0 || layer < nearest)) nearest = layer;
    }
    if (!fed && nearest > 0) layout.nodes[box].layer = nearest - 1;
  }
  for (const auto& node : layout.nodes) layout.layers = std::max(layout.layers, node.layer + 1);
}

/// Bends where an edge crosses layers.
void add_bends(GraphLayout& layout) {
  for (auto& edge : layout.edges) {
    edge.by = {edge.from};
    const int from = layout.nodes[static_cast<std::size_t>(edge.from)].layer,
              to = layout.nodes[static_cast<std::size_t>(edge.to)].layer;
    for (int layer = from + 1; !edge.backward && layer < to; ++layer) {
      edge.by.push_back(static_cast<int>(layout.nodes.size()));
      layout.nodes.push_back({layer, 0.0, 0.0, kBendSize});
    }
    edge.by.push_back(edge.to);
  }
}

using Weight = double (*)(bool a_is_box, bool b_is_box);

/// The weighted mean of `value` over the neighbours of each node: those before it (side -1), after it (1), or both (0).
std::vector<double> neighbour_means(const GraphLayout& layout, std::size_t boxes, int side, double LayoutNode::*value,
                                    Weight weight) {
  std::vector<double> sum(layout.nodes.size(), 0.0), count(layout.nodes.size(), 0.0);
  const auto add = [&](std::size_t to, std::size_t from, double w) {
    sum[to] += w * (layout.nodes[from].*value);
    count[to] += w;
  };
  for (const auto& edge : layout.edges) {
    if (edge.backward) continue;
    for (std::size_t i = 0; i + 1 < edge.by.size(); ++i) {
      const auto a = static_cast<std::size_t>(edge.by[i]), b = static_cast<std::size_t>(edge.by[i + 1]);
      const double w = weight(a < boxes, b < boxes);
      if (side <= 0) add(b, a, w);
      if (side >= 0) add(a, b, w);
    }
  }
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] = count[n] > 0.0 ? sum[n] / count[n] : layout.nodes[n].*value;
  return sum;
}

/// Long edges become straight first, then chains of boxes.
double straightness(bool a_is_box, bool b_is_box) { return a_is_box && b_is_box ? 2.0 : a_is_box || b_is_box ? 0.5 : 8.0; }

std::vector<std::vector<std::size_t>> nodes_by_layer(const GraphLayout& layout) {
  std::vector<std::vector<std::size_t>> layers(static_cast<std::size_t>(layout.layers));
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) layers[static_cast<std::size_t>(layout.nodes[n].layer)].push_back(n);
  for (auto& layer : layers)
    std::stable_sort(layer.begin(), layer.end(),
                     [&](std::size_t a, std::size_t b) { return layout.nodes[a].order < layout.nodes[b].order; });
  return layers;
}

void order_layers(GraphLayout& layout, std::size_t boxes) {
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) layout.nodes[n].order = static_cast<double>(n);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const auto means =
        neighbour_means(layout, boxes, sweep % 2 == 0 ? -1 : 1, &LayoutNode::order, [](bool, bool) { return 1.0; });
    for (std::size_t n = 0; n < means.size(); ++n) layout.nodes[n].order = means[n];
    for (const auto& layer : nodes_by_layer(layout))
      for (std::size_t i = 0; i < layer.size(); ++i) layout.nodes[layer[i]].order = static_cast<double>(i);
  }
}

/// Moves the nodes of a layer as near as possible to where they want to be, in their order and without overlap: the least
/// weighted sum of squares under these distances, by pooling neighbours that would overlap (isotonic regression).
void settle(GraphLayout& layout, std::size_t boxes, const std::vector<std::size_t>& layer, const std::vector<double>& wanted,
            double gap) {
  struct Pool {
    double weight, place;
    std::size_t count;
  };
  std::vector<double> offset(layer.size(), 0.0);
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < layer.size(); ++i) {
    if (i > 0) offset[i] = offset[i - 1] + 0.5 * (layout.nodes[layer[i - 1]].size + layout.nodes[layer[i]].size) + gap;
    pools.push_back({layer[i] < boxes ? 4.0 : 1.0, wanted[layer[i]] - offset[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].place > pools.back().place) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& pool = pools.back();
      pool.place = (pool.weight * pool.place + last.weight * last.place) / (pool.weight + last.weight);
      pool.weight += last.weight;
      pool.count += last.count;
    }
  }
  std::size_t i = 0;
  for (const auto& pool : pools)
    for (std::size_t n = 0; n < pool.count; ++n, ++i) layout.nodes[layer[i]].middle = pool.place + offset[i];
}

}  // namespace

GraphLayout layout_graph(const std::vector<double>& sizes, std::vector<LayoutEdge> edges, double gap) {
  GraphLayout layout;
  for (const double size : sizes) layout.nodes.push_back({0, 0.0, 0.0, size});
  layout.edges = std::move(edges);
  mark_backward(sizes.size(), layout.edges);
  place_in_layers(layout, sizes.size());
  add_bends(layout);
  order_layers(layout, sizes.size());
  const auto layers = nodes_by_layer(layout);
  const double largest = sizes.empty() ? 0.0 : *std::max_element(sizes.begin(), sizes.end());
  for (auto& node : layout.nodes) node.middle = node.order * (largest + gap);
  for (int sweep = 0; sweep < kSettlings; ++sweep) {
    const auto wanted = neighbour_means(layout, sizes.size(), 0, &LayoutNode::middle, straightness);
    for (const auto& layer : layers) settle(layout, sizes.size(), layer, wanted, gap);
  }
  double least = HUGE_VAL;
  for (const auto& node : layout.nodes) least = std::min(least, node.middle - 0.5 * node.size);
  for (auto& node : layout.nodes) node.middle -= least;
  return layout;
}

}  // namespace bodeflow::tools::report
