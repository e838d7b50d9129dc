#pragma once

#include <optional>

#include "graph/graph.hpp"
#include "report/picture.hpp"

namespace bodeflow::tools::report {

/// The blocks of a phase as boxes with their wires: streams solid, records dashed. Nothing for a phase without blocks or with
/// more than kMostBlocks.
std::optional<Picture> draw_phase(const graph::Phase& phase);

inline constexpr std::size_t kMostBlocks = 60;

}  // namespace bodeflow::tools::report
