#pragma once

#include <string>
#include <vector>

#include "execute/partition.hpp"

namespace bodeflow::execute {

/// Fills `run` (phase, facts, plan, sink and options are set) with blocks, memory, ops, routes and what stands at the start:
/// records of earlier phases and scheduled changes. Error: what does not fit together in the plan.
tl::expected<void, std::string> compile(Run& run, const std::vector<std::unique_ptr<Instance>>& instances,
                                        const std::vector<InitialRecord>& initial);

/// The message part of it: routes, origins, workers, entries at the start. Blocks and partitions exist.
tl::expected<void, std::string> compile_messages(Run& run, const std::vector<InitialRecord>& initial);

/// Index of the op of `partition` in which `block` is called.
std::int64_t op_of(const PartitionRun& partition, int block);

/// Says that the op of block `to` waits for op `op` of the thread of block `from`, where that is another thread.
void depend(Run& run, int from, std::int64_t op, int to, Lane::Wait kind, std::int64_t lag);

}  // namespace bodeflow::execute
