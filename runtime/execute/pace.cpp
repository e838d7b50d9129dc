#include "execute/pace.hpp"

#include <time.h>

#include <algorithm>

namespace bodeflow::execute {
namespace {

using Clock = std::chrono::steady_clock;

/// Long waits are cut, so that an end of the run is seen soon.
constexpr auto kLongest = std::chrono::milliseconds(20);

void sleep_until(Clock::time_point when) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(when.time_since_epoch()).count();
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  timespec at{};
  at.tv_sec = static_cast<time_t>(since / kNanoseconds);
  at.tv_nsec = static_cast<long>(since % kNanoseconds);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
  }
}

}  // namespace

bool wait_until(Run& run, Lane& lane, double time_s) {
  const auto when = run.started + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
  if (Clock::now() > when) run.overruns.fetch_add(1, std::memory_order_relaxed);
  while (!run.stop_wanted()) {
    const auto now = Clock::now();
    if (now >= when) return true;
    lane.beat();
    sleep_until(std::min(when, now + kLongest));
  }
  return false;
}

}  // namespace bodeflow::execute
