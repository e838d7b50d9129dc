#pragma once

#include <cstdint>
#include <deque>
#include <mutex>

#include "execute/inbox.hpp"
#include "execute/lane.hpp"

namespace bodeflow::execute {

struct BlockRun;

/// The thread of an asynchronous block: takes the entries that are handed to it, one after the other.
class Worker {
 public:
  Worker(BlockRun& block, Control& control) : block_(block), control_(control) {}

  BlockRun& block() { return block_; }
  Lane& lane() { return lane_; }
  Signal& work() { return work_; }
  Signal& answers() { return answers_; }

  /// Queues an entry; its number, counting from one. One thread at a time.
  std::int64_t hand(Entry entry);
  bool done(std::int64_t job) const { return done_.load(std::memory_order_acquire) >= job; }
  /// [any thread] Entries that were handed over and are not done.
  std::int64_t pending() const {
    const std::int64_t done = done_.load(std::memory_order_acquire);
    return handed_.load(std::memory_order_relaxed) - done;
  }
  /// Waits until `job` is done. False: the run is stopping.
  bool wait(std::int64_t job, int waiting, Lane& lane);
  /// Waits until all is done. False: the run is stopping.
  bool wait_all(Lane& lane) { return wait(handed_, -1, lane); }
  /// No more entries: `run` returns when all is done.
  void close();

  /// The thread's body.
  void run();

 private:
  BlockRun& block_;
  Control& control_;
  Lane lane_;
  Signal work_, answers_;
  std::mutex mutex_;
  std::deque<Entry> queue_;
  bool closed_ = false;
  std::atomic<std::int64_t> handed_{0};
  std::atomic<std::int64_t> done_{0};
};

}  // namespace bodeflow::execute
