#include <atomic>

#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

TEST_CASE("ends: a source that ends before its facts say so ends what depends on it, the rest goes on") {
  Bench bench;
  bench.add("short", "streams.counter", {{"ends", std::int64_t{450}}});
  bench.add("long", "streams.counter");
  bench.add("sum", "streams.sum", {{"sign", 1.0}});
  bench.add("tens", "streams.decimate", {{"factor", std::int64_t{100}}});
  bench.add("after", "streams.gain");
  bench.connect("long", "sum.in");
  bench.connect("short", "sum.feedback");
  bench.connect("sum", "tens");
  bench.connect("long", "after");
  bench.duration(1.0);
  for (const Cut& cut :
       {Cut{64, 1, 0, 0}, Cut{450, 1, 0, 0}, Cut{1000, 1, 0, 0}, Cut{64, 3, 7, 0}, Cut{1, 1, 0, 0}, Cut{90, 4, 0, 11}}) {
    const Result result = bench.run(cut);
    INFO("chunk " << cut.chunk << " threads " << cut.threads << result.outcome.reason);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    CHECK(result.stream("short.out").size() == 450);
    CHECK(result.stream("sum.out").size() == 450);
    CHECK(result.stream("tens.out").size() == 4);
    CHECK(result.stream("after.out").size() == 1000);
    CHECK(result.outcome.metrics[2].dropped == 550);
    CHECK(result.outcome.metrics[3].dropped == 50);
    CHECK(result.outcome.metrics[4].dropped == 0);
  }
}

TEST_CASE("ends: a delay does not lengthen a stream, in a loop neither") {
  Bench bench;
  bench.add("short", "streams.counter", {{"ends", std::int64_t{123}}});
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole", {{"delay", std::int64_t{1}}});
  bench.add("late", "streams.pole", {{"delay", std::int64_t{40}}});
  bench.add("clock", "streams.counter");
  bench.connect("short", "sum.in");
  bench.connect("plant", "sum.feedback");
  bench.connect("sum", "plant");
  bench.connect("sum", "late");
  bench.duration(0.5);
  const Result reference = bench.run();
  REQUIRE(reference.outcome.status == Outcome::Status::complete);
  CHECK(reference.stream("plant.out").size() == 123);
  CHECK(reference.stream("late.out").size() == 123);
  for (const Cut& cut : {Cut{1, 1, 0, 0}, Cut{16, 2, 3, 0}, Cut{123, 1, 0, 0}, Cut{50, 4, 0, 7}})
    CHECK(bench.run(cut).same_data(reference));
  for (const auto& metrics : reference.outcome.metrics) CHECK(metrics.dropped == 0);
}

TEST_CASE("ends: an end inside a loop of two rates leaves whole firings on both sides") {
  Bench bench;
  bench.add("short", "streams.counter", {{"ends", std::int64_t{47}}});
  bench.add("sum", "streams.sum");
  bench.add("sums", "streams.decimate", {{"factor", std::int64_t{10}}});
  bench.add("hold", "streams.hold", {{"factor", std::int64_t{10}}});
  bench.add("plant", "streams.pole", {{"delay", std::int64_t{10}}});
  bench.connect("short", "sum.in");
  bench.connect("plant", "sum.feedback");
  bench.connect("sum", "sums");
  bench.connect("sums", "hold");
  bench.connect("hold", "plant");
  bench.add("clock", "streams.counter");
  bench.duration(0.2);
  const Result reference = bench.run({1000, 1, 0, 0});
  INFO(reference.outcome.reason);
  REQUIRE(reference.outcome.status == Outcome::Status::complete);
  // 47 samples give 4 whole sums, these 40 held samples, and so a loop of 40.
  CHECK(reference.stream("sum.out").size() == 40);
  CHECK(reference.stream("sums.out").size() == 4);
  CHECK(reference.stream("hold.out").size() == 40);
  CHECK(reference.stream("plant.out").size() == 40);
  for (const Cut& cut : {Cut{10, 1, 0, 0}, Cut{20, 2, 1, 0}, Cut{50, 1, 2, 3}}) CHECK(bench.run(cut).same_data(reference));
}

TEST_CASE("ends: blocks finish in the order of the data and hear what earlier ones send in their finish") {
  Bench bench;
  bench.add("relay", "messages.relay");
  bench.add("latch", "messages.latch");
  bench.add("frame", "messages.frame", {{"length", std::int64_t{100}}, {"closing", true}});
  bench.add("count", "streams.counter");
  bench.connect("count", "frame");
  bench.connect("count", "latch");
  bench.tell("frame", "relay");
  bench.tell("relay", "latch.first");
  bench.duration(0.25);
  for (const Cut& cut : {Cut{1000, 1, 0, 0}, Cut{50, 1, 0, 0}, Cut{100, 2, 1, 0}, Cut{7, 4, 0, 0}}) {
    const Result result = bench.run(cut);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    std::vector<std::string> ends;
    for (const auto& [block, text] : result.log)
      if (block == "relay" || text.find("finish") == 0 || text.find("rest") != std::string::npos)
        ends.push_back(block + ": " + text);
    // sums of 0..99 and 100..199, then the 2 frames; the relay's -1 at its finish comes last
    CHECK(ends == std::vector<std::string>{"relay: got 4950 at 0.100000", "relay: got 14950 at 0.200000",
                                           "relay: got 2 at 0.200000", "relay: finish", "latch: 0 17429 @ 250 rest",
                                           "latch: 0 -1 @ 250 rest", "latch: finish @ 250"});
  }
}

TEST_CASE("ends: the caller's wish to stop leaves a partial run without finish") {
  Bench bench;
  std::atomic<bool> stop{false};
  int pieces = 0;
  bench.add("count", "streams.counter");
  bench.add("latch", "messages.latch");
  bench.connect("count", "latch");
  bench.duration(1e6);
  bench.options.stop = &stop;
  bench.on_samples = [&](const std::string& port) -> tl::expected<void, std::string> {
    if (port == "latch.out" && ++pieces == 3) stop = true;
    return {};
  };
  for (const int threads : {1, 2}) {
    pieces = 0;
    stop = false;
    const Result result = bench.run({100, threads, 0, 0});
    CHECK(result.outcome.status == Outcome::Status::partial);
    CHECK(result.outcome.interrupted);
    CHECK(result.outcome.failed_block == -1);
    CHECK(result.outcome.reason == "interrupted");
    CHECK(result.said("latch").empty());
    CHECK(result.stream("latch.out").size() == 300);
  }
}

TEST_CASE("ends: progress is told at the end, with the whole time") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.duration(2.5);
  std::vector<execute::Progress> told;
  bench.options.progress = [&](const execute::Progress& progress) { told.push_back(progress); };
  REQUIRE(bench.run().outcome.status == Outcome::Status::complete);
  REQUIRE_FALSE(told.empty());
  CHECK(told.back().time_s == Approx(2.5));
  CHECK(told.back().total_s == Approx(2.5));
  CHECK(told.back().rate > 0.0);
}

TEST_CASE("ends: a real-time clock does not run ahead of the wall") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain");
  bench.connect("count", "gain");
  bench.duration(0.05);
  bench.phase.run.clock = bench.options.clock = graph::Clock::realtime;
  const Result result = bench.run({10, 2, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  CHECK(result.stream("gain.out").size() == 50);
  CHECK(result.outcome.wall_s >= 0.04);  // the last of five chunks begins there
}

}  // namespace
}  // namespace bodeflow::test
