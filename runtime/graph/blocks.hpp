#pragma once

#include "graph/graph.hpp"
#include "graph/node.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::graph {

/// Reads `blocks` into phase.blocks. A block that is wrong stays in the list with type = nullptr (or with a default in the
/// place of a wrong value), so that what refers to it can be checked; the report then keeps the graph from being used.
void read_blocks(Node& node, const Registry& registry, Phase& phase, Report& report);

/// The unit of a block's numbers: what its parameter `unit` says; "" where it says nothing or the block has none.
std::string own_unit(const Block& block);

/// Values of a map of parameters, nested maps as dotted names.
struct WrittenParameter {
  int index;
  Node* node;
};

/// The parameters that are written below `node`; unknown names and repeats are reported. `skip`: a key that is none.
std::vector<WrittenParameter> written_parameters(Node& node, const BlockDescription& type, const std::string& owner,
                                                 const std::string& skip, Report& report);

}  // namespace bodeflow::graph
