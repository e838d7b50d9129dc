#include "graph/graph.hpp"

namespace bodeflow::graph {

int Phase::block_index(const std::string& block_name) const {
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i].name == block_name) return static_cast<int>(i);
  return -1;
}

}  // namespace bodeflow::graph
