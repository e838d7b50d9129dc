#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "execute/access.hpp"
#include "execute/violation.hpp"
#include "plan/plan.hpp"

namespace bodeflow::execute {

class RemoteEnd;

/// Who asked for a change of a live parameter.
enum class Cause { schedule, record, live };

/// Takes what a run keeps. Calls about one port come from one thread at a time; different ports may come from different threads.
class Sink {
 public:
  virtual ~Sink() = default;
  /// New samples of a recorded stream output (index into Phase::recorded): one address a channel. Throws nothing; an
  /// error (disk full) is returned and ends the run.
  virtual tl::expected<void, std::string> samples(int recorded, const void* const* channels, std::uint64_t count) = 0;
  /// A record of any message output of the phase, at its producer's time.
  virtual tl::expected<void, std::string> record(graph::End from, const SharedRecord& record, double time_s) = 0;
  /// A live parameter took a value before firing `position` of its block. (Of a block without streams: the period of the phase
  /// at whose begin it did, where the cause is `live`.)
  virtual void changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, Cause cause) = 0;
};

/// A change that was asked for while an earlier run went on, for its repetition: in effect where it was then.
struct PastChange {
  int block = 0;
  int parameter = 0;
  ParameterValue value;
  std::int64_t position = 0;  ///< as Sink::changed told
};

struct Options {
  std::uint64_t seed = 1;
  graph::Clock clock = graph::Clock::simulated;
  std::function<void(const std::string&)> warn;  ///< told on the caller's thread what the system did not permit
  double watchdog_s = 10.0;
  std::uint32_t vector_level = 1;                 ///< bf_activation::vector_level
  std::uint64_t first_chunk = 0;                  ///< repetitions of a shorter first chunk (tests of bit-identity); 0: none
  std::int64_t call_limit = 0;                    ///< most firings in one process call, 0: as many as the chunk has
  const std::atomic<bool>* stop = nullptr;        ///< set: end now, as partial
  std::function<void(const Progress&)> progress;  ///< called a few times a second from a thread of its own
  bool metrics = true;                            ///< time and calls of each block
  std::map<int, RemoteEnd*> remote_ends;          ///< by block: ends of links to other processes
  Rate least_end;                                 ///< seconds; when the run ends on other hosts at the earliest
  Observer* observer = nullptr;                   ///< sees the run and changes live parameters while it goes on
  std::vector<PastChange> past_changes;           ///< in the order in which they had effect
  /// Told on the caller's thread, within a tenth of a second, of the first violation of each limit (index into Plan::limits).
  std::function<void(int limit, const Violation&)> violated;
};

/// A record of an earlier phase for a message input, delivered at time zero.
struct InitialRecord {
  graph::End to;
  SharedRecord record;
};

struct BlockMetrics {
  std::uint64_t calls = 0, firings = 0;
  double seconds = 0.0;       ///< sampled, scaled up
  std::uint64_t dropped = 0;  ///< input samples left over at the end of the streams
};

struct Outcome {
  enum class Status { complete, partial };
  Status status = Status::complete;
  bool interrupted = false;  ///< by Options::stop
  int failed_block = -1;     ///< whose error ended the run, or -1
  int limit = -1;            ///< index into Plan::limits, of the one that ended the run, or -1
  bool hung = false;         ///< a block never came back: its thread lives on, so neither instances nor libraries may be freed
  std::string reason;        ///< why a run is partial
  double time_s = 0.0;       ///< of the run's clock that was done
  double wall_s = 0.0;
  std::uint64_t overruns = 0;  ///< real-time clock: chunks that began late, answers of asynchronous blocks that were waited for
  std::uint64_t skipped = 0;   ///< chunks of time that were left out: Overrun::skip
  Lateness lateness;           ///< realtime clock
  std::vector<std::string> not_permitted;  ///< priority, locked memory, cores: what the run went on without, and how to permit it
  std::vector<BlockMetrics> metrics;
  std::vector<LimitRecord> limits;  ///< as Plan::limits
};

/// What came of running a planned phase to its end: activates, processes, finishes, deactivates the instances. Never throws.
///
/// Threads: activate and deactivate are called on the caller's thread, a partition's blocks on that partition's thread,
/// asynchronous blocks on a worker each, finish on one thread after all of these; Sink on whichever thread runs the block. The
/// caller waits meanwhile and watches over their progress.
///
/// Ends: a delay does not lengthen a stream: a block makes floor(n / samples) firings for n samples that its producer made,
/// whatever the delay; what is left over is dropped and counted, the initial samples of a delay are not. The records that
/// take effect after a block's last firing are given to it before its finish(); changes are not.
///
/// Clocks: `realtime` begins each chunk at its absolute time of the steady clock. With `hardware` a device block holds the run
/// back while it waits for its samples; the engine does not pace.
///
/// Limits: a sample that leaves one acts as plan::Limit says: an input's before the block sees it, in whatever chunk it lies.
/// Where one ends the run, the block with that port makes no further firing, and no other block more than the limit's latency.
///
/// Errors end the run as partial, with the block and its own words; the first one of several threads stands. Blocks are
/// deactivated when the threads that call their process have left, whatever asynchronous blocks still compute. Without any call
/// completed for Options::watchdog_s (a finish: 60 times that) the run ends with a reason that names who waits for whom. A call
/// that hangs can't be cancelled: then `hung` is set, the block in that call is not deactivated, its thread stays behind,
/// detached, with its memory. The caller must not destroy that instance, or unload its plugin, and should end the process soon.
Outcome execute(const graph::Phase& phase, const plan::Facts& facts, const plan::Plan& plan,
                const std::vector<std::unique_ptr<Instance>>& instances, const std::vector<InitialRecord>& initial, Sink& sink,
                const Options& options);

}  // namespace bodeflow::execute
