#include "execute/pace.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>

namespace bodeflow::execute {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

/// Long waits are cut, so that an end of the run is seen soon.
constexpr auto kLongest = std::chrono::milliseconds(20);

void sleep_until(Clock::time_point when) {
  const auto since = std::chrono::duration_cast<nanoseconds>(when.time_since_epoch()).count();
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  timespec at{};
  at.tv_sec = static_cast<time_t>(since / kNanoseconds);
  at.tv_nsec = static_cast<long>(since % kNanoseconds);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
  }
}

nanoseconds length_of(const Run& run, std::int64_t periods) {
  return std::chrono::duration_cast<nanoseconds>(std::chrono::duration<double>(seconds(run.time_of_period(periods))));
}

/// False: the run ends.
bool take_overrun(Run& run, const Chunk& chunk, std::int64_t skipped, nanoseconds late) {
  run.overruns.fetch_add(1, std::memory_order_relaxed);
  if (run.phase->run.on_overrun == graph::Overrun::stop) {
    run.control.fail(-1, fmt::format("clock 'realtime': the chunk at {:.6g} s began {:.3g} ms late, and on_overrun is 'stop'",
                                     seconds(run.time_of_period(chunk.begin)), static_cast<double>(late.count()) * 1e-6));
    return false;
  }
  const nanoseconds length = length_of(run, run.chunking.periods);
  // Where another thread was first, it has skipped for all.
  if (run.phase->run.on_overrun == graph::Overrun::skip && length.count() > 0 && late >= length)
    run.skipped.compare_exchange_strong(skipped, skipped + late / length, std::memory_order_relaxed);
  return true;
}

}  // namespace

bool wait_for_time(PartitionRun& partition, const Chunk& chunk) {
  Run& run = *partition.run;
  const std::int64_t skipped = run.skipped.load(std::memory_order_relaxed);
  const Clock::time_point start{nanoseconds(run.clock_start.load(std::memory_order_relaxed))};
  const auto when = start + length_of(run, chunk.begin) + skipped * length_of(run, run.chunking.periods);
  auto now = Clock::now();
  if (now > when && !take_overrun(run, chunk, skipped, now - when)) return false;
  while (!run.stop_wanted()) {
    if (now >= when) {
      partition.lateness.add(nanoseconds(now - when).count());
      return true;
    }
    partition.lane.beat();
    sleep_until(std::min(when, now + kLongest));
    now = Clock::now();
  }
  return false;
}

}  // namespace bodeflow::execute
