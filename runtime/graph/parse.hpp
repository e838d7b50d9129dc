#pragma once

#include <optional>
#include <string>

#include "graph/node.hpp"

namespace bodeflow::graph {

inline constexpr int kDeepestNesting = 64;          ///< of lists and maps
inline constexpr std::size_t kMostNodes = 100'000;  ///< aliases expanded

/// The document of a YAML text, or nothing after a syntax error. Every problem is in the report: also those that leave a
/// document (duplicate keys, tags, merge keys). Aliases are expanded.
std::optional<Node> parse(const std::string& text, const Source& source, Report& report);

}  // namespace bodeflow::graph
