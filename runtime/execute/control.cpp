#include "execute/control.hpp"

#include <utility>

namespace bodeflow::execute {

void Control::fail(int block, std::string reason) { stop({false, block, std::move(reason), -1}); }

void Control::interrupt() { stop({true, -1, "interrupted", -1}); }

void Control::stop(End end) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_.load(std::memory_order_relaxed)) return;
    end_ = std::move(end);
    stopping_.store(true, std::memory_order_release);
  }
  for (Signal* signal : signals_) signal->raise();
}

Control::End Control::end() const {
  const std::lock_guard lock(mutex_);
  return end_;
}

}  // namespace bodeflow::execute
