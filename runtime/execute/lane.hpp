#pragma once

#include <cstdint>

#include "execute/control.hpp"

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace bodeflow::execute {

/// What a thread of a run does, for the watchdog to read. Written by its own thread alone.
class Lane {
 public:
  enum class Wait : std::uint64_t { none, samples, room, records, answer };

  struct Doing {
    std::uint64_t calls = 0;    ///< counts on with every call
    int block = -1;             ///< of the last call
    const char* function = "";  ///< of the block: process, change, finish
    Wait wait = Wait::none;     ///< other than none: not in a call
    int waiting = -1;           ///< which block waits
    int for_block = -1;         ///< and for which
    bool over = false;          ///< the thread has left
  };

  /// A call of `block` begins. One store: it stands in the innermost loop.
  void call(int block) {
    activity_.store(++calls_ << kBlockBits | static_cast<std::uint64_t>(block + 1), std::memory_order_release);
  }
  /// Alive without a call: a real-time clock that waits.
  void beat() { call(-1); }
  void function(const char* name) { function_.store(name, std::memory_order_relaxed); }
  void over() { over_.store(true, std::memory_order_release); }

  /// Waits for `done`, a look at what `signal` tells of: shortly spinning, then asleep. False: the run is stopping.
  template <class Done>
  bool wait(const Control& control, const Signal& signal, Wait kind, int waiting, int for_block, Done done) {
    for (int spin = 0; spin < kSpins; ++spin) {
      if (done()) return true;
      if (control.stopping()) return false;
      pause();
    }
    wait_.store(static_cast<std::uint64_t>(kind) << 60 | static_cast<std::uint64_t>(waiting + 1) << 30 |
                    static_cast<std::uint64_t>(for_block + 1),
                std::memory_order_release);
    bool ready = false;
    while (true) {
      const std::uint32_t epoch = signal.epoch();
      ready = done();
      if (ready || control.stopping()) break;
      signal.wait(epoch);
    }
    wait_.store(0, std::memory_order_release);
    return ready;
  }

  Doing doing() const {
    Doing d;
    const std::uint64_t activity = activity_.load(std::memory_order_acquire);
    const std::uint64_t wait = wait_.load(std::memory_order_acquire);
    d.calls = activity >> kBlockBits;
    d.block = static_cast<int>(activity & kBlockMask) - 1;
    d.function = function_.load(std::memory_order_relaxed);
    d.wait = static_cast<Wait>(wait >> 60);
    d.waiting = static_cast<int>(wait >> 30 & kWaitMask) - 1;
    d.for_block = static_cast<int>(wait & kWaitMask) - 1;
    d.over = over_.load(std::memory_order_acquire);
    return d;
  }

 private:
  static constexpr int kSpins =
      256;  ///< about a microsecond or two: a hand-over that is under way; longer only burns the other thread's core
  static constexpr int kBlockBits = 20;
  static constexpr std::uint64_t kBlockMask = (1u << kBlockBits) - 1;
  static constexpr std::uint64_t kWaitMask = (1u << 30) - 1;

  static void pause() {
#if defined(__x86_64__) || defined(__i386__)
    _mm_pause();
#endif
  }

  std::uint64_t calls_ = 0;
  alignas(64) std::atomic<std::uint64_t> activity_{0};
  std::atomic<std::uint64_t> wait_{0};
  std::atomic<const char*> function_{"process"};
  std::atomic<bool> over_{false};
};

}  // namespace bodeflow::execute
