#include "execute/remote_end.hpp"

#include "execute/partition.hpp"

namespace bodeflow::execute {

bool goes_on(BlockRun& block, Lane& lane) {
  lane.beat();
  return !block.run->stop_wanted();
}

Lane& lane_of(BlockRun& block) { return block.run->partitions[static_cast<std::size_t>(block.partition)]->lane; }

Lane& last_lane_of(BlockRun& block) { return block.run->finisher; }

}  // namespace bodeflow::execute
