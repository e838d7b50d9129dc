#include "console/drawing.hpp"

#include <fmt/format.h>

namespace bodeflow::tools {
namespace {

using graph::End;
using graph::Phase;

std::string node(std::size_t phase, int block) { return fmt::format("p{}b{}", phase, block); }

std::string port_name(const Phase& phase, std::uint32_t kind, std::uint32_t direction, const End& end) {
  if (end.port == graph::kParameterPort) return "parameters";
  return phase.blocks[static_cast<std::size_t>(end.block)].type->port_at(kind, direction, end.port).name;
}

std::string edge_label(const Phase& phase, std::uint32_t kind, const End& from, const End& to) {
  const std::string out = port_name(phase, kind, BF_OUT, from), in = port_name(phase, kind, BF_IN, to);
  return out == "out" && in == "in" ? "" : out + " - " + in;
}

struct Edge {
  std::string from, to, label;
  bool dashed;
};

std::vector<Edge> edges_of(const graph::Graph& graph) {
  std::vector<Edge> edges;
  for (std::size_t p = 0; p < graph.phases.size(); ++p) {
    const Phase& phase = graph.phases[p];
    for (const auto& edge : phase.streams)
      edges.push_back(
          {node(p, edge.from.block), node(p, edge.to.block), edge_label(phase, BF_STREAM, edge.from, edge.to), false});
    for (const auto& edge : phase.messages)
      edges.push_back(
          {node(p, edge.from.block), node(p, edge.to.block), edge_label(phase, BF_MESSAGE, edge.from, edge.to), true});
    for (const auto& reference : phase.references)
      for (std::size_t q = 0; q < p; ++q)
        if (graph.phases[q].name == reference.phase)
          edges.push_back(
              {node(q, graph.phases[q].block_index(reference.block)), node(p, reference.to.block), reference.port, true});
  }
  return edges;
}

}  // namespace

std::string to_dot(const graph::Graph& graph) {
  std::string text =
      "digraph bodeflow {\n  rankdir=LR;\n  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n  edge "
      "[fontname=\"sans-serif\", fontsize=10];\n";
  for (std::size_t p = graph.phases.size(); p-- > 0;) {  // Graphviz stacks them from below
    const Phase& phase = graph.phases[p];
    const std::string indent = phase.name.empty() ? "  " : "    ";
    if (!phase.name.empty())
      text += fmt::format("  subgraph cluster_{} {{\n    label=\"{}\";\n    fontname=\"sans-serif\";\n", p, phase.name);
    for (std::size_t b = 0; b < phase.blocks.size(); ++b)
      text += fmt::format("{}{} [label=\"{}\\n{}\"];\n", indent, node(p, static_cast<int>(b)), phase.blocks[b].name,
                          phase.blocks[b].type->id);
    if (!phase.name.empty()) text += "  }\n";
  }
  for (const auto& edge : edges_of(graph))
    text += fmt::format("  {} -> {} [label=\"{}\"{}];\n", edge.from, edge.to, edge.label, edge.dashed ? ", style=dashed" : "");
  return text + "}\n";
}

std::string to_mermaid(const graph::Graph& graph) {
  std::string text = "flowchart LR\n";
  for (std::size_t p = 0; p < graph.phases.size(); ++p) {
    const Phase& phase = graph.phases[p];
    if (!phase.name.empty()) text += fmt::format("  subgraph p{}[\"{}\"]\n", p, phase.name);
    for (std::size_t b = 0; b < phase.blocks.size(); ++b)
      text += fmt::format("  {}[\"{}<br>{}\"]\n", node(p, static_cast<int>(b)), phase.blocks[b].name, phase.blocks[b].type->id);
    if (!phase.name.empty()) text += "  end\n";
  }
  for (const auto& edge : edges_of(graph)) {
    const char* arrow = edge.dashed ? "-.->" : "-->";
    text += edge.label.empty() ? fmt::format("  {} {} {}\n", edge.from, arrow, edge.to)
                               : fmt::format("  {} {}|\"{}\"| {}\n", edge.from, arrow, edge.label, edge.to);
  }
  return text;
}

}  // namespace bodeflow::tools
