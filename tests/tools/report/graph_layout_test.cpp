#include "report/graph_layout.hpp"

#include <algorithm>
#include <cmath>

#include "catch.hpp"

using namespace bodeflow::tools::report;

namespace {

LayoutEdge edge(int from, int to) { return {from, to, false, {}}; }

/// Nodes of one layer that overlap.
int overlaps(const GraphLayout& layout) {
  int found = 0;
  for (std::size_t a = 0; a < layout.nodes.size(); ++a)
    for (std::size_t b = a + 1; b < layout.nodes.size(); ++b) {
      const auto &x = layout.nodes[a], &y = layout.nodes[b];
      if (x.layer == y.layer && std::abs(x.middle - y.middle) < 0.5 * (x.size + y.size)) ++found;
    }
  return found;
}

}  // namespace

TEST_CASE("report graph: a chain lies in layers one after the other, on one line") {
  const auto layout = layout_graph({44, 44, 44}, {edge(0, 1), edge(1, 2)}, 18);
  CHECK(layout.layers == 3);
  CHECK(layout.nodes[2].layer == 2);
  CHECK(layout.nodes[0].middle == Approx(layout.nodes[2].middle));
}

TEST_CASE("report graph: a loop has one edge that leads back, and an edge to itself leads back too") {
  const auto layout = layout_graph({44, 44, 44}, {edge(0, 1), edge(1, 2), edge(2, 0), edge(1, 1)}, 18);
  CHECK(std::count_if(layout.edges.begin(), layout.edges.end(), [](const LayoutEdge& e) { return e.backward; }) == 2);
  CHECK(layout.layers == 3);
}

TEST_CASE("report graph: an edge over several layers bends around the boxes between") {
  const auto layout = layout_graph({44, 44, 44, 44}, {edge(0, 1), edge(1, 2), edge(2, 3), edge(0, 3)}, 18);
  CHECK(layout.edges[3].by.size() == 4);
  CHECK(layout.nodes.size() == 6);
  CHECK(overlaps(layout) == 0);
}

TEST_CASE("report graph: sixty blocks in a tangle do not overlap") {
  std::vector<LayoutEdge> edges;
  for (int n = 0; n < 60; ++n) {
    edges.push_back(edge(n, (n * 7 + 3) % 60));
    edges.push_back(edge(n, (n * 11 + 5) % 60));
  }
  const auto layout = layout_graph(std::vector<double>(60, 44.0), edges, 18);
  CHECK(overlaps(layout) == 0);
  for (const auto& node : layout.nodes) CHECK(std::isfinite(node.middle));
}
