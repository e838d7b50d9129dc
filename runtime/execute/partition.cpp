// The thread of a partition: chunks, hand-over to other threads, pacing, ends.
#include "execute/partition.hpp"

#include <algorithm>
#include <exception>

#include "execute/pace.hpp"
#include "execute/scheduling.hpp"

namespace bodeflow::execute {

void PartitionRun::work() {
  if (run->paced()) wake_in_time();
  if (!run->pass_gate()) return;
  Chunk chunk;
  while (!run->stop_wanted()) {
    chunk.begin = chunk.end;
    chunk.end = run->chunking.end(chunk.index);
    chunk.timed = run->options.metrics && chunk.index % timing == 0;
    if (!pace(chunk) || !begin(chunk)) return;
    for (std::size_t i = 0; i < ops.size(); ++i) {
      const bool plain = ops[i].plain != nullptr && !chunk.timed && whole(chunk);
      if (!(plain ? run_plain(*ops[i].plain, chunk) : run_op(ops[i], static_cast<std::int64_t>(i), chunk))) return;
    }
    periods_done.store(chunk.end, std::memory_order_relaxed);
    done.store((chunk.index + 1) * static_cast<std::int64_t>(ops.size()), std::memory_order_release);
    if (run->partitions.size() > 1) signal.raise();
    if (over(chunk)) break;
    ++chunk.index;
  }
  if (run->control.stopping()) return;
  done.store(kNever, std::memory_order_release);
  signal.raise();
}

bool PartitionRun::pace(const Chunk& chunk) { return !run->paced() || chunk.index == 0 || wait_for_time(*this, chunk); }

/// Waits for room in the rings and moves the past of each buffer to its front.
bool PartitionRun::begin(const Chunk& chunk) {
  const std::int64_t before = chunk.begin - run->chunking.end(chunk.index - 2);  // periods of the chunk before
  for (const Carried& c : carried) {
    const BufferView& buffer = run->memory[c.buffer];
    for (const int reader : c.readers) {
      PartitionRun& other = *run->partitions[static_cast<std::size_t>(reader)];
      const std::int64_t needed =
          (chunk.index - static_cast<std::int64_t>(buffer.slots) + 1) * static_cast<std::int64_t>(other.ops.size());
      const auto room = [&] { return other.done.load(std::memory_order_acquire) >= needed; };
      if (!room() && !lane.wait(run->control, other.signal, Lane::Wait::room, c.writer, other.blocks.front()->index, room))
        return false;
    }
    if (chunk.index == 0 || buffer.history == 0) continue;
    buffer.copy(buffer.slot(chunk.index - 1), static_cast<std::uint64_t>(before * c.per_repetition), buffer,
                buffer.slot(chunk.index), 0, buffer.history);
  }
  return true;
}

bool PartitionRun::wait_for(const Dependency& dependency, const Chunk& chunk) {
  PartitionRun& other = *run->partitions[static_cast<std::size_t>(dependency.partition)];
  const std::int64_t in_chunk = chunk.index - dependency.lag;
  if (in_chunk < 0) return true;
  const std::int64_t needed = in_chunk * static_cast<std::int64_t>(other.ops.size()) + dependency.op + 1;
  const auto there = [&] { return other.done.load(std::memory_order_acquire) >= needed; };
  return there() || lane.wait(run->control, other.signal, dependency.kind, dependency.waiting, dependency.for_block, there);
}

/// What run_op comes to for a plain op in a whole chunk.
bool PartitionRun::run_plain(BlockRun& block, const Chunk& chunk) {
  if (!fire_here(block, chunk.end * block.per_repetition - block.position, lane)) return false;
  block.reached.store(block.position, std::memory_order_relaxed);
  return true;
}

bool PartitionRun::run_op(Op& op, std::int64_t op_index, const Chunk& chunk) {
  for (const Dependency& dependency : op.dependencies)
    if (!wait_for(dependency, chunk)) return false;
  bool go_on = true;
  if (op.kind == plan::Step::Kind::call)
    go_on = run_call(op, chunk);
  else if (op.kind == plan::Step::Kind::cluster)
    go_on = run_cluster(op, chunk);
  else
    for (CopyRun& one : op.copies) {
      one.done = chunk.begin * one.writer->per_repetition;
      copy(one, chunk);
    }
  // A limit's violation is kept too: it is what a reader of the recording looks for.
  const bool keep = go_on || std::any_of(op.blocks.begin(), op.blocks.end(), [](const BlockRun* block) {
                      return block->guard != nullptr && block->guard->stopped() >= 0;
                    });
  if (keep && !op.recorded.empty() && !record(op, chunk)) return false;
  if (!go_on) return false;
  for (BlockRun* block : op.blocks) block->reached.store(block->position, std::memory_order_relaxed);
  if (op.followed) {
    done.store(chunk.index * static_cast<std::int64_t>(ops.size()) + op_index + 1, std::memory_order_release);
    signal.raise();
  }
  return true;
}

void PartitionRun::copy(CopyRun& one, const Chunk& chunk) {
  const BufferView &from = run->memory[one.from], &to = run->memory[one.to];
  const std::int64_t made = one.writer->position - one.done;
  if (made <= 0) return;
  const auto place = static_cast<std::uint64_t>((one.done - chunk.begin * one.writer->per_repetition) * one.samples);
  from.copy(from.slot(chunk.index), from.history + place, to, to.slot(chunk.index), to.history + place,
            static_cast<std::uint64_t>(made * one.samples));
  one.done = one.writer->position;
}

bool PartitionRun::record(Op& op, const Chunk& chunk) {
  for (Recorded& recorded : op.recorded) {
    const std::int64_t made = recorded.block->position - chunk.begin * recorded.block->per_repetition;
    if (made <= 0) continue;
    const BufferView& buffer = run->memory[recorded.buffer];
    for (std::uint32_t c = 0; c < buffer.channels; ++c)
      recorded.channels[c] = buffer.at(buffer.slot(chunk.index), c, buffer.history);
    const auto kept =
        run->sink->samples(recorded.index, recorded.channels.data(), static_cast<std::uint64_t>(made * recorded.samples));
    if (kept) continue;
    run->control.fail(-1, kept.error());
    return false;
  }
  return true;
}

/// Whether this thread is through: its streams have ended and its blocks without streams get nothing more.
bool PartitionRun::over(const Chunk& chunk) {
  if (whole(chunk) && chunk.end < full_periods) return false;
  bool open = false;
  for (const BlockRun* block : blocks) {
    if (block->has_streams()) {
      if (block->end.load(std::memory_order_relaxed) > chunk.end * block->per_repetition) return false;
    } else {
      open = open || !block->horizon.endless;
    }
  }
  if (streams_ended.load(std::memory_order_relaxed) == kNever) streams_ended.store(chunk.end, std::memory_order_release);
  if (!open) return true;
  // Blocks without streams that wait for each other in a circle never hear of an end: all streams' ends are theirs.
  return std::all_of(run->partitions.begin(), run->partitions.end(), [&](const auto& partition) {
    return partition->streams_ended.load(std::memory_order_acquire) <= chunk.end;
  });
}

}  // namespace bodeflow::execute
