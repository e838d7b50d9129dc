#pragma once

#include <string>

#include "graph/node.hpp"

namespace bodeflow::graph {

/// A graph file is not longer than this; a list of numbers that is belongs in a data file.
inline constexpr std::size_t kLargestFile = 4u << 20;

/// True when the bytes may be given to yaml-cpp: UTF-8 without control characters, no tab in an indentation, not empty,
/// not too long. Otherwise every reason is in the report. yaml-cpp guesses other encodings, takes the byte 0x04 for the end
/// of the file and reads some tabs as nothing.
bool is_readable(std::string_view text, const Source& source, Report& report);

}  // namespace bodeflow::graph
