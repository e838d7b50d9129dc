#pragma once

#include <cstdint>
#include <vector>

#include "execute/run.hpp"

namespace bodeflow::execute {

/// What another partition must have done before an op of this one may begin.
struct Dependency {
  int partition = 0;
  std::int64_t op = 0;  ///< index of its op, in the chunk that is `lag` chunks before
  std::int64_t lag = 0;
  Lane::Wait kind = Lane::Wait::samples;
  int waiting = 0;    ///< block that waits
  int for_block = 0;  ///< and for which
};

/// Samples that go on to a second buffer, as far as their block has made them.
struct CopyRun {
  BlockRun* writer = nullptr;
  std::int64_t samples = 1;  ///< a firing
  int from = 0, to = 0;
  std::int64_t done = 0;  ///< firings whose samples are copied
};

/// A recorded stream output.
struct Recorded {
  int index = 0;  ///< into Phase::recorded
  const BlockRun* block = nullptr;
  std::int64_t samples = 1;  ///< a firing
  int buffer = 0;
  std::vector<const void*> channels;
};

/// One entry of a cluster's schedule: firings, a turn of a block without streams, or a copy.
struct Turn {
  enum class Kind { fire, take, copy };
  Kind kind = Kind::fire;
  BlockRun* block = nullptr;
  std::int64_t count = 1;
  std::size_t copy = 0;  ///< index into Op::copies
};

struct Op {
  BlockRun* plain = nullptr;  ///< a call without records, recording or other threads: its streams stand at the chunk's start
  plan::Step::Kind kind = plan::Step::Kind::call;
  BlockRun* block = nullptr;  ///< call
  std::vector<Turn> turns;    ///< cluster: one pass
  std::int64_t repetitions = 1, parts = 1;
  std::vector<CopyRun> copies;    ///< of a copy step, or of a cluster
  std::vector<BlockRun*> blocks;  ///< called here, each once
  bool has_source = false;        ///< cluster: a block in it may end its streams by itself
  std::vector<Dependency> dependencies;
  std::vector<Recorded> recorded;
  bool followed = false;  ///< another partition waits for it
};

/// A buffer that this partition writes and whose past it carries on from chunk to chunk.
struct Carried {
  int buffer = 0;
  std::int64_t per_repetition = 0;  ///< samples in a period of the phase
  std::vector<int> readers;         ///< other partitions
  int writer = 0;                   ///< block
};

/// One thread of the plan: runs its ops chunk by chunk until its blocks have ended.
struct PartitionRun {
  Run* run = nullptr;
  int index = 0;
  std::vector<Op> ops;
  std::vector<Carried> carried;
  std::vector<BlockRun*> blocks;
  std::int64_t full_periods = 0;  ///< no block here ends before these are over, as far as the facts say
  std::int64_t timing = 64;       ///< every so many chunks are measured
  Lane lane;
  LatenessCounter lateness;
  Signal signal;                      ///< `done` or `periods_done` went on
  std::atomic<std::int64_t> done{0};  ///< ops done since the start; kNever: over
  std::atomic<std::int64_t> periods_done{0};
  std::atomic<std::int64_t> streams_ended{kNever};  ///< periods after which the blocks with streams had all ended

  /// The thread's body.
  void work();

 private:
  bool begin(const Chunk& chunk);
  bool pace(const Chunk& chunk);
  bool wait_for(const Dependency& dependency, const Chunk& chunk);
  bool run_op(Op& op, std::int64_t op_index, const Chunk& chunk);
  bool run_plain(BlockRun& block, const Chunk& chunk);
  bool run_call(Op& op, const Chunk& chunk);
  bool run_cluster(Op& op, const Chunk& chunk);
  bool run_pass(Op& op, const Chunk& chunk, std::int64_t end, bool timed);
  bool run_whole_pass(Op& op, const Chunk& chunk);
  bool run_turn(Op& op, const Turn& turn, std::int64_t count, const Chunk& chunk, bool timed);
  bool settle_records(Op& op, const Chunk& chunk);
  bool record(Op& op, const Chunk& chunk);
  void copy(CopyRun& one, const Chunk& chunk);
  bool whole(const Chunk& chunk) const { return chunk.end <= full_periods && !run->ends_changed.load(std::memory_order_relaxed); }
  bool over(const Chunk& chunk);
};

}  // namespace bodeflow::execute
