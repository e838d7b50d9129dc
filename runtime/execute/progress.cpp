#include "execute/progress.hpp"

#include <algorithm>
#include <chrono>

namespace bodeflow::execute {
namespace {

constexpr auto kEvery = std::chrono::milliseconds(250);

}  // namespace

Progress progress_of(const Run& run) {
  std::int64_t periods = kNever;
  for (const auto& partition : run.partitions) {
    const bool streams =
        std::any_of(partition->blocks.begin(), partition->blocks.end(), [](const BlockRun* b) { return b->has_streams(); });
    if (streams) periods = std::min(periods, partition->periods_done.load(std::memory_order_relaxed));
  }
  Progress progress;
  progress.total_s = seconds(run.end_time());
  progress.time_s = periods == kNever ? 0.0 : seconds(run.time_of_period(periods));
  if (progress.total_s > 0.0) progress.time_s = std::min(progress.time_s, progress.total_s);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - run.started).count();
  progress.rate = wall_s > 0.0 ? progress.time_s / wall_s : 0.0;
  return progress;
}

Reporter::Reporter(const Run& run) : run_(run) {
  if (run.options.progress) thread_ = std::thread([this] { work(); });
}

Reporter::~Reporter() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void Reporter::work() {
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, kEvery, [this] { return end_; })) {
    lock.unlock();
    run_.options.progress(progress_of(run_));
    lock.lock();
  }
  lock.unlock();
  run_.options.progress(progress_of(run_));
}

}  // namespace bodeflow::execute
