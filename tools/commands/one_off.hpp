#pragma once

#include <string>

#include "commands/command.hpp"
#include "commands/run_graph.hpp"

namespace bodeflow::tools {

/// A command that writes a graph of its own and runs it.
struct OneOff {
  std::string name;   ///< of the command: names the run directory
  std::string graph;  ///< its text
  std::vector<std::pair<std::string, std::string>> overrides;
  std::string out;  ///< run directory; empty: below runs/
  bool json = false;
};

/// Runs the graph as `bodeflow run` does and prints its results, with --json as JSON. What is wrong with the graph is said
/// without places in it: nobody wrote it.
RanGraph run_one_off(const Session& session, Registry& registry, const OneOff& command);

/// The text without "block 'NAME': " in front.
std::string without_block(const std::string& text, const std::string& block);

/// A word as a shell takes it.
std::string shell_word(const std::string& word);

}  // namespace bodeflow::tools
