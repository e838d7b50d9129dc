#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

/// The latch's firings of a record stream: "0 value @ position".
std::vector<std::string> expected_latches(std::int64_t rate_p, std::int64_t rate_c, std::int64_t latency_num,
                                          std::int64_t latency_den, std::int64_t firings_p, std::int64_t firings_c) {
  std::vector<std::string> lines;
  for (std::int64_t p = 0; p < firings_p; ++p) {
    std::int64_t m = 0;  // the first with m / rate_c >= p / rate_p + latency, by trial in integers
    while (m * rate_p * latency_den < (p * latency_den + latency_num * rate_p) * rate_c) ++m;
    lines.push_back("0 " + std::to_string(p) + " @ " + std::to_string(std::min(m, firings_c)) + (m >= firings_c ? " rest" : ""));
  }
  return lines;
}

TEST_CASE("messages: records of a 3 Hz producer reach a 7 Hz consumer at the exact firing, for any latency") {
  for (const auto& [num, den] : {std::pair<std::int64_t, std::int64_t>{0, 1}, {1, 3}, {1, 7}, {1, 1000}, {5, 4}}) {
    Bench bench;
    bench.add("pulse", "messages.pulse", {{"rate", 3.0}});
    bench.add("count", "streams.counter", {{"rate", 7.0}});
    bench.add("latch", "messages.latch");
    bench.connect("count", "latch");
    bench.tell("pulse", "latch.first", after(num, den));
    bench.duration(10.0);
    for (const Cut& cut : {Cut{1024, 1, 0, 0}, Cut{7, 1, 0, 0}, Cut{14, 3, 1, 0}, Cut{21, 2, 0, 2}}) {
      const Result result = bench.run(cut);
      INFO("latency " << num << "/" << den << " chunk " << cut.chunk << ": " << result.outcome.reason);
      REQUIRE(result.outcome.status == Outcome::Status::complete);
      auto expected = expected_latches(3, 7, num, den, 30, 70);
      expected.push_back("finish @ 70");
      CHECK(result.said("latch") == expected);
    }
  }
}

TEST_CASE("messages: a latency in samples counts on the consumer's clock") {
  Bench bench;
  bench.add("pulse", "messages.pulse", {{"rate", 10.0}});
  bench.add("count", "streams.counter", {{"rate", 100.0}});
  bench.add("latch", "messages.latch");
  bench.connect("count", "latch");
  bench.tell("pulse", "latch.first", after_samples(13));
  bench.duration(0.5);
  const Result result = bench.run({64, 1, 0, 0});
  CHECK(result.said("latch") ==
        std::vector<std::string>{"0 0 @ 13", "0 1 @ 23", "0 2 @ 33", "0 3 @ 43", "0 4 @ 50 rest", "finish @ 50"});
}

TEST_CASE("messages: records due at one firing come in the order of time, edge and sequence") {
  Bench bench;
  bench.add("a", "messages.pulse", {{"rate", 20.0}});
  bench.add("b", "messages.pulse", {{"rate", 10.0}});
  bench.add("count", "streams.counter", {{"rate", 5.0}});
  bench.add("latch", "messages.latch");
  bench.connect("count", "latch");
  bench.tell("b", "latch.second");
  bench.tell("a", "latch.first");
  bench.duration(0.4);
  for (const int threads : {1, 4}) {
    const Result result = bench.run({1024, threads, 0, 0});
    CHECK(result.said("latch") == std::vector<std::string>{"1 0 @ 0", "0 0 @ 0", "0 1 @ 1", "1 1 @ 1", "0 2 @ 1", "0 3 @ 1",
                                                           "1 2 @ 1", "0 4 @ 1", "0 5 @ 2 rest", "1 3 @ 2 rest", "0 6 @ 2 rest",
                                                           "0 7 @ 2 rest", "finish @ 2"});
  }
}

TEST_CASE("messages: a block without streams sends with the time at which its record took effect") {
  Bench bench;
  bench.add("pulse", "messages.pulse", {{"rate", 4.0}});
  bench.add("relay", "messages.relay", {{"factor", 1.0}});
  bench.add("count", "streams.counter", {{"rate", 1000.0}});
  bench.add("latch", "messages.latch");
  bench.connect("count", "latch");
  bench.tell("pulse", "relay", after(1, 10));
  bench.tell("relay", "latch.first", after(1, 100));
  bench.duration(1.0);
  const Result result = bench.run({100, 2, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  const auto& sent = result.records.at("relay.out");
  REQUIRE(sent.size() == 5);
  for (std::size_t i = 0; i < 4; ++i) CHECK(sent[i].time_s == Approx(0.25 * static_cast<double>(i) + 0.1).epsilon(1e-15));
  CHECK(sent[4].time_s == 1.0);
  CHECK(sent[3].value() == 3.0 + 0.5 * (2.0 + 0.5 * 1.0));
  CHECK(result.said("latch") ==
        std::vector<std::string>{"0 0 @ 110", "0 1 @ 360", "0 2 @ 610", "0 4 @ 860", "0 -1 @ 1000 rest", "finish @ 1000"});
  CHECK(result.said("relay").front() == "got 0 at 0.000000");
}

TEST_CASE("messages: records of an earlier phase come before the first firing") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("latch", "messages.latch");
  bench.add("relay", "messages.relay");
  bench.connect("count", "latch");
  bench.tell("relay", "latch.second");
  bench.give("latch.first", 40.0);
  bench.give("relay.in", 1.0);
  bench.duration(0.01);
  const Result result = bench.run();
  CHECK(result.said("latch") == std::vector<std::string>{"0 40 @ 0", "1 2 @ 0", "1 -1 @ 10 rest", "finish @ 10"});
  CHECK(result.stream("latch.out")[0] == 2.0);
}

TEST_CASE("messages: a phase without streams passes on what it is given and finishes") {
  Bench bench;
  bench.add("last", "messages.relay");
  bench.add("slow", "messages.slow_relay");
  bench.add("first", "messages.relay");
  bench.tell("first", "slow");
  bench.tell("slow", "last", after(1, 2));
  bench.give("first.in", 1.0);
  for (const int threads : {1, 3}) {
    const Result result = bench.run({1024, threads, 0, 0});
    INFO(result.outcome.reason);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto& sent = result.records.at("last.out");
    // 1 -> 2 -> 4 -> 8; the -1 of each finish on its way through those after it
    REQUIRE(sent.size() == 4);
    CHECK(sent[0].value() == 8.0);
    CHECK(sent[0].time_s == 0.5);
    CHECK(sent.back().value() == -1.0);
  }
}

TEST_CASE("messages: whoever takes the answer of an asynchronous block waits for it") {
  Bench bench;
  bench.add("pulse", "messages.pulse", {{"rate", 100.0}});
  bench.add("slow", "messages.slow_relay", {{"factor", 1.0}});
  bench.add("count", "streams.counter");
  bench.add("latch", "messages.latch");
  bench.connect("count", "latch");
  bench.tell("pulse", "slow");
  bench.duration(1.0);
  SECTION("with a latency, at exactly that latency") { bench.tell("slow", "latch.first", after(3, 1000)); }
  SECTION("without, at once") { bench.tell("slow", "latch.first"); }
  const std::int64_t latency = bench.phase.messages.back().latency.seconds.num;
  for (const Cut& cut : {Cut{1000, 1, 0, 0}, Cut{10, 1, 0, 0}, Cut{50, 2, 0, 0}, Cut{1, 4, 0, 0}}) {
    const Result result = bench.run(cut);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto said = result.said("latch");
    REQUIRE(said.size() == 102);
    for (std::int64_t i = 0; i < 100; ++i) {
      const std::string at = " @ " + std::to_string(10 * i + latency);
      CHECK(said[static_cast<std::size_t>(i)].substr(said[static_cast<std::size_t>(i)].find(" @")) == at);
    }
  }
}

}  // namespace
}  // namespace bodeflow::test
