#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "execute/watchdog.hpp"

namespace bodeflow::execute {

/// The threads of a run, and who watches over them.
class Crew {
 public:
  explicit Crew(std::shared_ptr<Run> run) : run_(std::move(run)), state_(std::make_shared<State>()) {}

  /// Starts a thread that keeps the run alive; its handle. An exception of `body` ends the run.
  std::thread::native_handle_type start(Lane& lane, std::string name, std::function<void()> body);

  /// Waits until the threads from index `first` on are over, passing on the caller's wish to stop and ending the run when no call
  /// is completed for Options::watchdog_s. False: a thread hangs.
  bool watch(std::size_t first = 0);

  /// Joins what is over, leaves behind what hangs; the blocks in whose calls threads hang.
  std::vector<int> disband();

  /// Why the caller could not wait any longer; "" where nothing hangs.
  const std::string& hang() const { return hang_; }
  std::size_t size() const { return members_.size(); }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
  };

  bool all_over(std::size_t first) const;

  std::shared_ptr<Run> run_;
  std::shared_ptr<State> state_;
  std::vector<Member> members_;
  std::string hang_;
};

}  // namespace bodeflow::execute
