#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "execute/lateness.hpp"
#include "plugins/description.hpp"

namespace bodeflow::execute {

struct Run;

struct Progress {
  double time_s = 0.0;   ///< of the run's clock, done
  double total_s = 0.0;  ///< 0: not known
  double rate = 0.0;     ///< seconds of the run's clock per second of wall time
};

/// How full the buffer of a stream between two threads is.
struct RingState {
  int from = 0;  ///< block
  int to = 0;    ///< block
  int port = 0;  ///< stream input of `to`
  std::int64_t filled = 0;
  std::int64_t slots = 0;  ///< chunks
};

/// What can be seen of a run from outside while it goes on.
struct State {
  Progress progress;
  std::uint64_t overruns = 0, skipped = 0;  ///< as in Outcome
  Lateness lateness;
  std::vector<std::int64_t> firings;  ///< by block
  std::vector<RingState> rings;
  std::vector<std::int64_t> waiting;  ///< by block: records that wait for an asynchronous block; -1 for others
};

/// A change of a live parameter that somebody asked for while the run goes on, and what became of it.
struct Asked {
  static constexpr std::int64_t kWaiting = -1, kRefused = -2;

  int block = 0;
  int parameter = 0;
  ParameterValue value;
  /// The firing of the block from which on it has effect; of a block without streams, the period of the phase.
  std::atomic<std::int64_t> position{kWaiting};
  std::string refusal;    ///< refused: the block's own words
  Asked* next = nullptr;  ///< while it waits: what was asked for before it
};

/// The way into a run from outside: what it shows, and changes of live parameters. For any thread; no thread of the run ever
/// waits for it or takes memory because of it, but for the change itself.
class Access {
 public:
  explicit Access(Run& run) : run_(run) {}

  State state() const;
  /// Hands over a change whose value is checked. The block's thread takes it before the first firing of its next chunk and then
  /// sets `position`. `asked` lives until the run has ended.
  void ask(Asked& asked);

 private:
  Run& run_;
};

/// Somebody who is given access to a run while its threads are there. Called on the thread of the caller of `execute`.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void begins(Access& access) = 0;
  /// No use of the access is under way or made from now on.
  virtual void ends() = 0;
};

}  // namespace bodeflow::execute
