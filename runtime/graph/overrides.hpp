#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graph/document.hpp"
#include "graph/variables.hpp"

namespace bodeflow::graph {

/// One --set PATH=VALUE.
struct Override {
  std::vector<std::string> path;
  Node value;
};

/// The overrides as nodes of their own sources. A value that begins with [ or { is read as YAML, any other is a text as it
/// stands; an empty one is no value.
std::vector<Override> read_overrides(const std::vector<std::pair<std::string, std::string>>& overrides, Document& document,
                                     Report& report);

/// Sets the variables that the overrides name, and takes these overrides out of the list.
void set_variables(std::vector<Override>& overrides, Variables& variables, Report& report);

/// Sets values in the document. A path is `key...` from the top, `block.parameter`, `phase.block.parameter` or
/// `phase.key...`; `block.parameter` reaches the block in every phase that has it.
void apply(const std::vector<Override>& overrides, const Variables& variables, Node& root, Report& report);

/// Writes a value under `run` of the graph, and of each phase that states one of its own: --seed and --for.
void apply_run_key(const std::string& key, const std::string& text, const Source& source, Node& root);

}  // namespace bodeflow::graph
