#pragma once

#include <optional>

#include "graph/graph.hpp"
#include "report/picture.hpp"

namespace bodeflow::tools::report {

/// The blocks of a phase as boxes with their wires: streams solid, records dashed. From left to right where that fits into
/// `width`, else from above downwards (which may still be wider). Nothing for a phase without blocks or with more than
/// kMostBlocks.
///
/// With `notes` every box has room for a third line, a <text> with the attribute data-block (index into Phase::blocks), to be
/// filled in by the page.
std::optional<Picture> draw_phase(const graph::Phase& phase, double width, bool notes = false);

inline constexpr std::size_t kMostBlocks = 60;

}  // namespace bodeflow::tools::report
