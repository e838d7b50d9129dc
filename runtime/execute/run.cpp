#include "execute/run.hpp"

#include "execute/partition.hpp"

namespace bodeflow::execute {

Run::Run() = default;
Run::~Run() = default;

void Run::open_gate() {
  open.store(true, std::memory_order_release);
  gate.raise();
}

bool Run::pass_gate() {
  while (!open.load(std::memory_order_acquire) && !control.stopping()) {
    const std::uint32_t epoch = gate.epoch();
    if (!open.load(std::memory_order_acquire) && !control.stopping()) gate.wait(epoch);
  }
  std::int64_t nobody = 0;
  clock_start.compare_exchange_strong(nobody, std::chrono::steady_clock::now().time_since_epoch().count());
  return !control.stopping();
}

void Run::warn(const std::string& text) {
  not_permitted.push_back(text);
  if (options.warn) options.warn(text);
}

bool Run::stop_wanted() {
  if (control.stopping()) return true;
  if (options.stop == nullptr || !options.stop->load(std::memory_order_relaxed)) return false;
  control.interrupt();
  return true;
}

void Run::tell_violations() {
  if (!options.violated) return;
  for (std::size_t i = 0; i < limiters.size(); ++i)
    if (limiters[i]->news()) options.violated(static_cast<int>(i), limiters[i]->first());
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
