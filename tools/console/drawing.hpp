#pragma once

#include <string>

#include "graph/graph.hpp"

namespace bodeflow::tools {

/// The graph in Graphviz's language: a cluster a phase; streams as solid arrows, records as dashed ones.
std::string to_dot(const graph::Graph& graph);

/// The graph as a Mermaid flow chart.
std::string to_mermaid(const graph::Graph& graph);

}  // namespace bodeflow::tools
