#include "execute/run.hpp"

#include "execute/partition.hpp"

namespace bodeflow::execute {

Run::Run() = default;
Run::~Run() = default;

bool Run::stop_wanted() {
  if (control.stopping()) return true;
  if (options.stop == nullptr || !options.stop->load(std::memory_order_relaxed)) return false;
  control.interrupt();
  return true;
}

Time Run::end_time() const {
  Time latest = multiple_of(1, options.least_end);
  for (const auto& block : blocks) {
    const std::int64_t end = block->end.load(std::memory_order_relaxed);
    if (!block->has_streams() || end == kNever || block->remote != nullptr) continue;
    const Time time = time_of(end, block->rate);
    if (latest < time) latest = time;
  }
  return latest;
}

}  // namespace bodeflow::execute
