#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "execute/signal.hpp"

namespace bodeflow::execute {

/// Why and that a run ends early; shared by all of its threads. The first reason stands.
class Control {
 public:
  struct End {
    bool interrupted = false;
    int block = -1;
    std::string reason;
    int limit = -1;
  };

  /// Ends the run because of `block` (-1: none). Any thread.
  void fail(int block, std::string reason);
  /// Ends the run because a limit was violated. No memory is taken: the reason is told later.
  void violate(int limit) { stop({false, -1, {}, limit}); }
  /// Ends the run because the caller asked for it.
  void interrupt();
  bool stopping() const { return stopping_.load(std::memory_order_acquire); }
  End end() const;

  /// The caller has returned while a thread hangs in a block: nothing of the caller's may be touched any more.
  void abandon() { abandoned_.store(true, std::memory_order_release); }
  bool abandoned() const { return abandoned_.load(std::memory_order_acquire); }

  /// A signal that is raised when the run ends early. Before any thread starts.
  void watch(Signal& signal) { signals_.push_back(&signal); }

 private:
  void stop(End end);

  mutable std::mutex mutex_;
  End end_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> abandoned_{false};
  std::vector<Signal*> signals_;
};

}  // namespace bodeflow::execute
