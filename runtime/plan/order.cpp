#include "plan/order.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/strong_components.hpp>
#include <functional>
#include <queue>

namespace bodeflow::plan {

std::vector<int> topological_order(int nodes, const std::vector<Arc>& arcs) {
  std::vector<std::vector<int>> next(nodes);
  std::vector<int> waiting(nodes, 0);
  for (const auto& [from, to] : arcs) {
    next[from].push_back(to);
    ++waiting[to];
  }
  std::priority_queue<int, std::vector<int>, std::greater<>> free;
  for (int node = 0; node < nodes; ++node) {
    if (waiting[node] == 0) free.push(node);
  }
  std::vector<int> order;
  order.reserve(nodes);
  while (!free.empty()) {
    const int node = free.top();
    free.pop();
    order.push_back(node);
    for (const int other : next[node]) {
      if (--waiting[other] == 0) free.push(other);
    }
  }
  return order;
}

std::vector<Component> ordered_components(int nodes, const std::vector<Arc>& arcs) {
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS>;
  Graph graph(nodes);
  for (const auto& [from, to] : arcs) boost::add_edge(from, to, graph);
  std::vector<int> label(nodes);
  const int count =
      boost::strong_components(graph, boost::make_iterator_property_map(label.begin(), boost::get(boost::vertex_index, graph)));

  // Numbered by their smallest node, so that the order does not depend on how the search went.
  std::vector<int> number(count, -1);
  std::vector<Component> components;
  for (int node = 0; node < nodes; ++node) {
    int& mine = number[label[node]];
    if (mine < 0) {
      mine = static_cast<int>(components.size());
      components.emplace_back();
    }
    components[mine].nodes.push_back(node);
  }
  std::vector<Arc> between;
  for (const auto& [from, to] : arcs) {
    const int a = number[label[from]], b = number[label[to]];
    if (a == b) {
      components[a].loop = true;
    } else {
      between.emplace_back(a, b);
    }
  }
  std::vector<Component> ordered;
  for (const int index : topological_order(count, between)) ordered.push_back(std::move(components[index]));
  return ordered;
}

}  // namespace bodeflow::plan
