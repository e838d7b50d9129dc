#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "graph/graph.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::graph {

struct LoadOptions {
  std::vector<std::pair<std::string, std::string>> overrides;  ///< --set PATH=VALUE, in order
  std::optional<std::uint64_t> seed{};                         ///< --seed
  std::string duration{};                                      ///< --for; empty: as the graph says
};

/// The checked graph of a YAML file, or every problem in it at once. Reads files, runs no code of a plugin.
tl::expected<Graph, Problems> load(const std::string& file, const LoadOptions& options, const Registry& registry);

/// The same for a text that is already read; `file` is used in messages and for relative paths.
tl::expected<Graph, Problems> load_text(const std::string& text, const std::string& file, const LoadOptions& options,
                                        const Registry& registry);

}  // namespace bodeflow::graph
