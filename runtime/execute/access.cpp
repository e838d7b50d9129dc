#include "execute/access.hpp"

#include <algorithm>

#include "execute/partition.hpp"
#include "execute/progress.hpp"

namespace bodeflow::execute {
namespace {

/// Chunks that a thread has done.
std::int64_t chunks_of(const PartitionRun& partition) {
  const std::int64_t done = partition.done.load(std::memory_order_acquire);
  return done == kNever ? kNever : done / std::max<std::int64_t>(1, static_cast<std::int64_t>(partition.ops.size()));
}

std::vector<RingState> rings_of(const Run& run) {
  std::vector<RingState> rings;
  for (const graph::StreamEdge& edge : run.phase->streams) {
    const auto from = static_cast<std::size_t>(edge.from.block), to = static_cast<std::size_t>(edge.to.block);
    const int writer = run.plan->partition_of[from], reader = run.plan->partition_of[to];
    if (writer == reader) continue;
    RingState ring{edge.from.block, edge.to.block, edge.to.port, 0, 0};
    const int buffer = run.plan->inputs[to][static_cast<std::size_t>(edge.to.port)].buffer;
    ring.slots = run.plan->buffers[static_cast<std::size_t>(buffer)].slots;
    const std::int64_t taken = chunks_of(*run.partitions[static_cast<std::size_t>(reader)]);
    const std::int64_t made = chunks_of(*run.partitions[static_cast<std::size_t>(writer)]);
    if (made != kNever && taken != kNever) ring.filled = std::clamp<std::int64_t>(made - taken, 0, ring.slots);
    rings.push_back(ring);
  }
  return rings;
}

}  // namespace

State Access::state() const {
  State state;
  state.progress = progress_of(run_);
  state.overruns = run_.overruns.load(std::memory_order_relaxed);
  state.skipped = static_cast<std::uint64_t>(run_.skipped.load(std::memory_order_relaxed));
  LatenessCounter lateness;
  for (const auto& partition : run_.partitions) lateness.add(partition->lateness);
  state.lateness = lateness.summary();
  for (const auto& block : run_.blocks) {
    state.firings.push_back(block->reached.load(std::memory_order_relaxed));
    state.waiting.push_back(block->worker < 0 ? -1 : run_.workers[static_cast<std::size_t>(block->worker)]->pending());
  }
  state.rings = rings_of(run_);
  return state;
}

void Access::ask(Asked& asked) {
  std::atomic<Asked*>& last = run_.block(asked.block).asked;
  asked.next = last.load(std::memory_order_relaxed);
  while (!last.compare_exchange_weak(asked.next, &asked, std::memory_order_release, std::memory_order_relaxed)) {
  }
}

}  // namespace bodeflow::execute
