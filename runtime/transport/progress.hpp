#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "transport/settings.hpp"

namespace bodeflow::transport {

/// How long the calls on one end of an edge wait, and since when in vain. made() and the figures: from any thread.
class Progress {
 public:
  explicit Progress(double tolerance_s) : tolerance_s_(tolerance_s) {}

  void made() { last_ns_.store(now_ns()); }
  /// Since the last progress or the begin of the wait, whichever is later; 0: nothing waits.
  double stalled_s() const;
  double waited_s() const;
  bool too_long() const { return stalled_s() >= tolerance_s_; }
  double tolerance_s() const { return tolerance_s_; }

  /// While it lives a call waits.
  class Wait {
   public:
    explicit Wait(Progress& progress);
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;
    ~Wait();

   private:
    Progress& progress_;
  };

 private:
  static std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  double tolerance_s_;
  std::atomic<std::int64_t> last_ns_{0};
  std::atomic<std::int64_t> since_ns_{0};  // 0: nothing waits
  std::atomic<std::int64_t> total_ns_{0};
};

/// Waits with `lock` for `done`; asks `go_on` at least every 50 ms, without the lock. Nothing: done. Else stopped or tolerance.
template <typename Done>
std::optional<Failure::Kind> wait_for(std::unique_lock<std::mutex>& lock, std::condition_variable& changed, Progress& progress,
                                      const GoOn& go_on, Done done) {
  if (done()) return std::nullopt;
  const Progress::Wait wait(progress);
  while (!changed.wait_for(lock, std::chrono::milliseconds(50), done)) {
    lock.unlock();
    const bool on = !go_on || go_on();
    lock.lock();
    if (done()) return std::nullopt;
    if (!on) return Failure::Kind::stopped;
    if (progress.too_long()) return Failure::Kind::tolerance;
  }
  return std::nullopt;
}

/// `10 s`, `0.25 s`: for messages.
std::string seconds_text(double seconds);

}  // namespace bodeflow::transport
