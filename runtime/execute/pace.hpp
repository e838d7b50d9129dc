#pragma once

#include "execute/partition.hpp"

namespace bodeflow::execute {

/// Sleeps until the chunk's absolute time on the steady clock, counts how late it begins, and deals with an overrun as the run
/// wishes. False: the run is stopping.
bool wait_for_time(PartitionRun& partition, const Chunk& chunk);

}  // namespace bodeflow::execute
