#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "execute/block.hpp"
#include "execute/execute.hpp"
#include "execute/limits.hpp"
#include "execute/memory.hpp"
#include "execute/worker.hpp"

namespace bodeflow::execute {

/// A stretch of the run: periods of the phase [begin, end).
struct Chunk {
  std::int64_t index = 0;
  std::int64_t begin = 0, end = 0;
  bool timed = false;  ///< its calls are measured
};

/// How a run is cut: chunks of `periods` periods of the phase, the first one shorter where `first` > 0.
struct Chunking {
  std::int64_t periods = 1;
  std::int64_t first = 0;

  /// Where chunk `index` ends; 0 for those before the first.
  std::int64_t end(std::int64_t index) const {
    if (index < 0) return 0;
    return first > 0 ? first + index * periods : (index + 1) * periods;
  }
};

struct PartitionRun;

/// Everything that the threads of a run share. They keep it alive: a thread that hangs in a block still has its memory.
struct Run {
  const graph::Phase* phase = nullptr;
  const plan::Facts* facts = nullptr;
  const plan::Plan* plan = nullptr;
  Sink* sink = nullptr;
  Options options;
  std::vector<graph::ScheduledChange> schedule;

  Control control;
  Memory memory;
  std::vector<std::unique_ptr<BlockRun>> blocks;  ///< as Phase::blocks
  std::vector<std::unique_ptr<PartitionRun>> partitions;
  std::vector<std::unique_ptr<Worker>> workers;
  std::vector<std::unique_ptr<Limiter>> limiters;  ///< as Plan::limits
  std::vector<std::unique_ptr<Guard>> guards;
  Lane finisher;

  Rate period;  ///< seconds; zero: no streams
  Chunking chunking;
  std::atomic<bool> ends_changed{false};  ///< a source ended before its facts said so
  std::atomic<std::uint64_t> overruns{0};
  std::atomic<std::int64_t> skipped{0};  ///< chunks of time left out of the schedule
  std::chrono::steady_clock::time_point started;
  std::vector<std::string> not_permitted;  ///< of the caller's thread
  Signal gate;                             ///< compute threads wait here until each has its priority and cores
  std::atomic<bool> open{false};
  std::atomic<std::int64_t> clock_start{0};  ///< of a paced run, when the first thread began: nanoseconds of the steady clock

  Run();
  ~Run();

  BlockRun& block(int index) { return *blocks[static_cast<std::size_t>(index)]; }
  const std::string& name(int index) const { return phase->blocks[static_cast<std::size_t>(index)].name; }
  /// Outside time passes while the run goes on.
  bool realtime() const { return options.clock != graph::Clock::simulated; }
  /// The engine holds the run back.
  bool paced() const { return options.clock == graph::Clock::realtime; }
  /// When the last block with streams ends, as far as the ends are known; zero: not.
  Time end_time() const;
  /// The time when period `count` of the phase begins.
  Time time_of_period(std::int64_t count) const { return multiple_of(count, period); }
  /// Lets the compute threads go.
  void open_gate();
  /// On a compute thread, before its first chunk: waits for the gate. False: the run is ending.
  bool pass_gate();
  /// Keeps and tells what the system did not permit. The caller's thread.
  void warn(const std::string& text);
  /// Ends the run where the caller wishes it. True: it is ending.
  bool stop_wanted();
  /// Tells the caller of limits that were violated since it was told last. On the caller's thread.
  void tell_violations();
};

}  // namespace bodeflow::execute
