// The calls of a chunk: single blocks, and feedback loops by their schedule.
#include <algorithm>

#include "execute/partition.hpp"

namespace bodeflow::execute {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// What a look at the clock costs itself; measured once. Short calls would seem twice as long otherwise.
double clock_cost_s() {
  static const double cost = [] {
    double least = 1.0;
    for (int i = 0; i < 64; ++i) least = std::min(least, since(Clock::now()));
    return least;
  }();
  return cost;
}

bool advance_timed(BlockRun& block, std::int64_t count, bool limited, Lane& lane) {
  const std::int64_t before = block.position;
  const auto started = Clock::now();
  const bool go_on = advance(block, count, limited, lane);
  block.timed_s += std::max(0.0, since(started) - clock_cost_s());
  block.timed_firings += block.position - before;
  return go_on;
}

/// The ends inside a loop depend on each other: lowered until nothing changes.
void settle_ends(const Op& op) {
  for (bool changed = true; changed;) {
    changed = false;
    for (BlockRun* block : op.blocks) changed = (block->has_streams() && update_end(*block)) || changed;
  }
}

}  // namespace

bool PartitionRun::run_call(Op& op, const Chunk& chunk) {
  BlockRun& block = *op.block;
  if (!block.has_streams()) return take_turn(block, chunk, lane);
  if (block.takes_messages) collect(block);
  std::int64_t end = chunk.end * block.per_repetition;
  if (!whole(chunk)) {
    update_end(block);
    end = std::min(end, block.end.load(std::memory_order_relaxed));
  }
  const std::int64_t count = end - block.position;
  bool go_on = true;
  if (count > 0) {
    begin_chunk(block, chunk);
    const bool limited = run->options.call_limit > 0;
    go_on = chunk.timed ? advance_timed(block, count, limited, lane) : advance(block, count, limited, lane);
    rewind(block);
  }
  if (block.remote == nullptr || !go_on || block.position < block.end.load(std::memory_order_relaxed)) return go_on;
  return block.remote->ended(block, lane);
}

bool PartitionRun::run_cluster(Op& op, const Chunk& chunk) {
  for (BlockRun* block : op.blocks) {
    if (block->takes_messages) collect(*block);
    if (block->has_streams()) begin_chunk(*block, chunk);
  }
  for (CopyRun& one : op.copies) one.done = chunk.begin * one.writer->per_repetition;
  bool all = whole(chunk);
  if (!all) {
    settle_ends(op);
    all = std::all_of(op.blocks.begin(), op.blocks.end(), [&](const BlockRun* block) {
      return block->end.load(std::memory_order_relaxed) >= chunk.end * block->per_repetition;
    });
  }
  const std::int64_t last = chunk.end * op.parts;
  bool timed = chunk.timed;
  for (std::int64_t at = chunk.begin * op.parts; at < last; at += op.repetitions) {
    const bool planned = all && !timed && !op.has_source && last - at >= op.repetitions;
    if (!(planned ? run_whole_pass(op, chunk) : run_pass(op, chunk, std::min(at + op.repetitions, last), timed))) return false;
    timed = false;  // one pass stands for all: a look at the clock costs more than a short firing
  }
  return settle_records(op, chunk);
}

/// One pass in which no block ends: all counts are as planned.
bool PartitionRun::run_whole_pass(Op& op, const Chunk& chunk) {
  const bool limited = run->options.call_limit > 0;
  for (const Turn& turn : op.turns) {
    if (turn.kind == Turn::Kind::fire) [[likely]] {
      if (!advance(*turn.block, turn.count, limited, lane)) return false;
    } else if (!run_turn(op, turn, turn.count, chunk, false)) {
      return false;
    }
  }
  return true;
}

/// One pass up to period `end` of the loop: a block fires as often as is left for it until then, and until its own end. What
/// a firing reads was made by firings that are not cut either, so the order of the schedule still holds.
bool PartitionRun::run_pass(Op& op, const Chunk& chunk, std::int64_t end, bool timed) {
  for (const Turn& turn : op.turns) {
    std::int64_t count = turn.count;
    const BlockRun& block = *turn.block;
    if (turn.kind == Turn::Kind::fire) {
      const std::int64_t stop = std::min(end * (block.per_repetition / op.parts), block.end.load(std::memory_order_relaxed));
      count = std::min(count, stop - block.position);
      if (count <= 0) continue;
    }
    const std::int64_t expected = block.position + count;
    if (!run_turn(op, turn, count, chunk, timed)) return false;
    if (block.source && block.position < expected) settle_ends(op);
  }
  return true;
}

bool PartitionRun::run_turn(Op& op, const Turn& turn, std::int64_t count, const Chunk& chunk, bool timed) {
  BlockRun& block = *turn.block;
  if (turn.kind == Turn::Kind::copy) {
    copy(op.copies[turn.copy], chunk);
    return true;
  }
  if (turn.kind == Turn::Kind::take) return take_turn(block, chunk, lane);
  return timed ? advance_timed(block, count, run->options.call_limit > 0, lane)
               : advance(block, count, run->options.call_limit > 0, lane);
}

/// At the end of a chunk a loop's blocks without streams take all that is certain by then: who reads outside the loop counts
/// on it.
bool PartitionRun::settle_records(Op& op, const Chunk& chunk) {
  for (std::size_t round = 0; round < op.blocks.size(); ++round) {
    bool taken = false;
    for (BlockRun* block : op.blocks) {
      if (block->has_streams()) continue;
      const bool waiting = !block->inbox.empty();
      if (!take_turn(*block, chunk, lane)) return false;
      taken = taken || waiting;
    }
    if (!taken) break;
  }
  return true;
}

}  // namespace bodeflow::execute
