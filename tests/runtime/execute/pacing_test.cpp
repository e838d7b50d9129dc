// How a run keeps to outside time: overruns, lateness, priority and cores.
#include <sched.h>
#include <sys/resource.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "bench.hpp"
#include "catch.hpp"
#include "execute/lateness.hpp"

namespace bodeflow::test {
namespace {

using Catch::Matchers::Contains;
using execute::Lateness;
using execute::LatenessCounter;
using execute::Outcome;

/// A counter at 1 kHz in chunks of 10 ms; the thread is held up for 35 ms in the third one.
Bench held_up(graph::Overrun on_overrun) {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.duration(0.15);
  bench.phase.run.clock = bench.options.clock = graph::Clock::realtime;
  bench.phase.run.on_overrun = on_overrun;
  bench.on_samples = [chunks = 0](const std::string&) mutable -> tl::expected<void, std::string> {
    if (++chunks == 3) std::this_thread::sleep_for(std::chrono::milliseconds(35));
    return {};
  };
  return bench;
}

constexpr Cut kChunks{10, 1, 0, 0};

TEST_CASE("pacing: lateness is counted by octaves from one microsecond") {
  LatenessCounter counter;
  for (const std::int64_t ns : {-5, 0, 999, 1000, 1999, 2000, 4096000, 2000000000}) counter.add(ns);
  const Lateness all = counter.summary();
  CHECK(all.chunks == 8);
  CHECK(all.min_s == 0.0);
  CHECK(all.max_s == Approx(2.0));
  REQUIRE(all.bins.size() == Lateness::kBins);
  CHECK(all.bins[0] == 3);
  CHECK(all.bins[1] == 2);
  CHECK(all.bins[2] == 1);
  CHECK(all.bins[13] == 1);  // 4.096 to 8.192 ms
  CHECK(all.bins[21] == 1);
  CHECK(std::accumulate(all.bins.begin(), all.bins.end(), std::uint64_t{0}) == 8);
}

TEST_CASE("pacing: median and 99 % of lateness are right to a sixteenth of their octave") {
  LatenessCounter one, other;
  for (std::int64_t us = 1; us <= 1000; ++us) (us % 2 == 0 ? one : other).add(us * 1000);
  one.add(other);
  const Lateness all = one.summary();
  CHECK(all.chunks == 1000);
  CHECK(all.min_s == Approx(1e-6));
  CHECK(all.max_s == Approx(1e-3));
  CHECK(std::abs(all.median_s - 500e-6) < 256e-6 / 16);
  CHECK(std::abs(all.p99_s - 990e-6) < 512e-6 / 16);
  CHECK(LatenessCounter().summary().bins.empty());
}

TEST_CASE("pacing: a run that is held up counts the late chunks and catches up") {
  Bench bench = held_up(graph::Overrun::count);
  const Result result = bench.run(kChunks);
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  CHECK(result.stream("count.out").size() == 150);
  CHECK(result.outcome.overruns >= 3);
  CHECK(result.outcome.skipped == 0);
  CHECK(result.outcome.lateness.chunks == 14);  // the first one begins the clock
  CHECK(result.outcome.lateness.max_s >= 0.025);
}

TEST_CASE("pacing: a run that skips loses time but no sample") {
  Bench bench = held_up(graph::Overrun::skip);
  const Result result = bench.run(kChunks);
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  const auto& samples = result.stream("count.out");
  REQUIRE(samples.size() == 150);
  for (std::size_t n = 0; n < samples.size(); ++n) REQUIRE(samples[n] == static_cast<double>(n));
  CHECK(result.outcome.skipped >= 2);    // 25 ms late: two chunks of 10 ms
  CHECK(result.outcome.wall_s >= 0.16);  // the last chunk began at 140 ms, and two chunks later
}

TEST_CASE("pacing: two threads skip the same lost time once") {
  Bench bench = held_up(graph::Overrun::skip);
  bench.add("gain", "streams.gain");
  bench.connect("count", "gain");
  const Result result = bench.run({10, 2, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  REQUIRE(result.threads == 2);
  CHECK(result.stream("gain.out").size() == 150);
  CHECK(result.outcome.skipped >= 1);
}

TEST_CASE("pacing: a run that may not be late ends and says how late it was") {
  Bench bench = held_up(graph::Overrun::stop);
  const Result result = bench.run(kChunks);
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.failed_block == -1);
  CHECK_THAT(result.outcome.reason, Catch::Matchers::Matches("clock 'realtime': the chunk at 0\\.[0-9]+ s began [0-9.]+ ms late, "
                                                             "and on_overrun is 'stop'"));
}

TEST_CASE("pacing: a hardware clock leaves the pace to the blocks") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.duration(100.0);
  bench.phase.run.clock = bench.options.clock = graph::Clock::hardware;
  const Result result = bench.run();
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  CHECK(result.outcome.wall_s < 10.0);
  CHECK(result.outcome.lateness.chunks == 0);
}

TEST_CASE("pacing: compute threads have the cores and the priority of the run or it says why not") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.duration(0.05);
  bench.phase.run.clock = bench.options.clock = graph::Clock::realtime;
  bench.phase.run.priority = 5;
  bench.phase.run.cores = {0};
  std::vector<std::string> warnings;
  bench.options.warn = [&](const std::string& text) { warnings.push_back(text); };
  int policy = -1, priority = -1, cores = 0;
  bench.on_samples = [&](const std::string&) -> tl::expected<void, std::string> {
    sched_param param{};
    policy = sched_getscheduler(0);
    sched_getparam(0, &param);
    priority = param.sched_priority;
    cpu_set_t set;
    sched_getaffinity(0, sizeof set, &set);
    cores = CPU_COUNT(&set);
    return {};
  };
  REQUIRE(bench.run(kChunks).outcome.status == Outcome::Status::complete);
  CHECK(cores == 1);
  if (warnings.empty()) {
    CHECK(policy == SCHED_FIFO);
    CHECK(priority == 5);
  }
  for (const auto& warning : warnings) CHECK_THAT(warning, Contains("the run goes on without"));
}

TEST_CASE("pacing: a core that is not there is told and the run goes on") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.duration(0.02);
  bench.phase.run.clock = bench.options.clock = graph::Clock::realtime;
  bench.phase.run.cores = {1023};
  std::vector<std::string> warnings;
  bench.options.warn = [&](const std::string& text) { warnings.push_back(text); };
  REQUIRE(bench.run(kChunks).outcome.status == Outcome::Status::complete);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0] == "cores: no thread can be bound to core 1023: this process has no such core; the run goes on without");
}

}  // namespace
}  // namespace bodeflow::test
