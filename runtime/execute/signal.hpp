#pragma once

#include <atomic>
#include <cstdint>

namespace bodeflow::execute {

/// Something changed: who waits looks again. A waiter reads `epoch`, looks, then waits for an epoch other than that one.
class Signal {
 public:
  std::uint32_t epoch() const { return epoch_.load(std::memory_order_acquire); }
  void wait(std::uint32_t seen) const { epoch_.wait(seen, std::memory_order_acquire); }
  void raise() {
    epoch_.fetch_add(1, std::memory_order_acq_rel);
    epoch_.notify_all();
  }

 private:
  alignas(64) std::atomic<std::uint32_t> epoch_{0};
};

}  // namespace bodeflow::execute
