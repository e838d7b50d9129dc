#pragma once

#include <string>

#include "graph/load.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::graph {

/// A registry with one block for each thing that a description can say; version 1.2.3 of every family.
const Registry& test_registry();

/// The graph of a text that is named `g.yaml`, or its problems as the user sees them.
tl::expected<Graph, std::string> load_test(const std::string& text, const LoadOptions& options = {});

/// The same for a graph that must be good: its problems become an exception.
Graph good(const std::string& text, const LoadOptions& options = {});

/// The problems of a graph that must be bad.
std::string problems(const std::string& text, const LoadOptions& options = {});

}  // namespace bodeflow::graph
