#pragma once

#include <deque>
#include <optional>
#include <string>

#include "graph/node.hpp"

namespace bodeflow::graph {

/// A graph file with everything that it includes, as one tree; nodes point to the sources.
struct Document {
  std::deque<Source> sources;
  Node root;

  const Source& add_source(std::string file, std::string folder, bool command_line = false);
};

/// Text of a graph file; nothing, with the reason in the report, when it can't be read.
std::optional<std::string> read_file(const std::string& file, const Spot& asked_for, Report& report);

/// Parses a text and everything that it includes into `document.root`: included blocks, variables, connections and changes
/// stand before the file's own. False: not worth checking further.
bool assemble(const std::string& text, const std::string& file, Document& document, Report& report);

}  // namespace bodeflow::graph
