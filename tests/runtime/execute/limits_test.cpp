// Limits: what a block gets, when a run ends, what is told. An actuator is a gain of one, whose output is what it got.
#include <unistd.h>

#include <cmath>
#include <limits>

#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Bound;
using execute::Outcome;
using graph::OnViolation;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

graph::Quantity quantity(double value) { return {std::to_string(value), {}}; }

/// x[n] = n at 1 kHz, with `offset` added from sample `at` to the next.
struct Line {
  Bench bench;

  explicit Line(double offset = 0.0, int at = 0, double slope = 1.0) {
    bench.add("count", "streams.counter");
    bench.add("disturb", "streams.gain", {{"gain", slope}});
    bench.add("actuator", "streams.gain");
    bench.connect("count", "disturb");
    bench.connect("disturb", "actuator");
    bench.duration(0.5);
    if (offset == 0.0) return;
    bench.schedule(at * 1e-3, "disturb", "offset", offset);
    bench.schedule((at + 1) * 1e-3, "disturb", "offset", 0.0);
  }
};

const std::vector<Cut> kCuts = {{1024, 1, 0, 0}, {1, 1, 0, 0}, {7, 1, 3, 0}, {64, 1, 0, 5},
                                {64, 2, 0, 0},   {7, 3, 0, 0}, {1, 2, 0, 0}};

TEST_CASE("limits: an actuator gets the nearest allowed value from the sample on that leaves its limit") {
  for (const Cut& cut : kCuts) {
    Line line;
    graph::Limit& limit = line.bench.limit_input("actuator.in");
    limit.min = quantity(10.0);
    limit.max = quantity(99.5);
    const Result result = line.bench.run(cut);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto& got = result.stream("actuator.out");
    REQUIRE(got.size() == 500);
    for (std::size_t n = 0; n < got.size(); ++n) REQUIRE(got[n] == std::clamp(static_cast<double>(n), 10.0, 99.5));
    CHECK(result.stream("disturb.out")[499] == 499.0);  // others see the signal as it came
    const execute::LimitRecord& seen = result.outcome.limits.at(0);
    CHECK(seen.samples == 500);
    CHECK(seen.violations == 10 + 400);
    REQUIRE(seen.first);
    CHECK(seen.first->bound == Bound::min);
    CHECK(seen.first->position == 0);
    CHECK(seen.lowest == 0.0);
    CHECK(seen.highest == 499.0);
    CHECK(seen.steepest == 1000.0);
  }
}

TEST_CASE("limits: an actuator's input changes no faster than allowed, from 0 on") {
  for (const Cut& cut : kCuts) {
    Line line(100.0, 200, 0.0);  // a pulse of 100 in a signal of zeros
    line.bench.limit_input("actuator.in").rate = quantity(2000.0);
    const Result result = line.bench.run(cut);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto& got = result.stream("actuator.out");
    for (std::size_t n = 0; n < got.size(); ++n) REQUIRE(got[n] == (n == 200 ? 2.0 : 0.0));
    CHECK(result.outcome.limits[0].violations == 1);
    CHECK(result.outcome.limits[0].first->position == 200);
    CHECK(result.outcome.limits[0].first->bound == Bound::rate);
    CHECK(result.outcome.limits[0].first->value == Approx(100e3));
    CHECK(result.outcome.limits[0].steepest == Approx(100e3));
  }
}

TEST_CASE("limits: a change exactly as fast as allowed is no violation") {
  Line line(0.0, 0, 0.1);
  line.bench.limit_input("actuator.in").rate = quantity(100.0);
  const Result result = line.bench.run();
  CHECK(result.outcome.limits[0].violations == 0);
  CHECK(result.stream("actuator.out") == result.stream("disturb.out"));
}

TEST_CASE("limits: a sample that is no number is replaced by the last one that was allowed") {
  for (const Cut& cut : kCuts) {
    Line line(kNan, 100);
    graph::Limit& limit = line.bench.limit_input("actuator.in");
    limit.max = quantity(1000.0);
    limit.rate = quantity(1500.0);
    const Result result = line.bench.run(cut);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto& got = result.stream("actuator.out");
    CHECK(got[99] == 99.0);
    CHECK(got[100] == 99.0);
    CHECK(got[101] == 100.5);  // back at the allowed rate
    CHECK(got[102] == 102.0);
    CHECK(got[499] == 499.0);
    CHECK(result.outcome.limits[0].violations == 2);
    CHECK(result.outcome.limits[0].first->bound == Bound::finite);
    CHECK(result.outcome.limits[0].first->position == 100);
  }
}

TEST_CASE("limits: the value and the rate both hold for any signal, the same bits for every cut") {
  Bench bench;
  bench.add("noise", "streams.noise", {{"channels", std::int64_t{3}}});
  bench.add("actuator", "streams.gain");
  bench.add("other", "streams.pole", {{"pole", 0.9}});
  bench.connect("noise", "actuator");
  bench.connect("noise", "other");
  bench.duration(1.0);
  graph::Limit& limit = bench.limit_input("actuator.in");
  limit.channel = "1";
  limit.min = quantity(-0.2);
  limit.max = quantity(0.3);
  limit.rate = quantity(90.0);
  const Result result = bench.run();
  const auto& came = result.streams.at("noise.out");
  const auto& got = result.streams.at("actuator.out");
  CHECK(got[0] == came[0]);
  CHECK(got[2] == came[2]);
  double before = 0.0;
  for (const double y : got[1]) {
    REQUIRE(y >= -0.2);
    REQUIRE(y <= 0.3);
    REQUIRE(std::abs(y - before) <= 0.09 * (1.0 + 1e-8));
    before = y;
  }
  CHECK(result.outcome.limits[0].violations > 300);
  bench.check_identity();
}

TEST_CASE("limits: an actuator that runs several samples a firing, behind a delay and in a loop, is held sample by sample") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole", {{"pole", 0.9}, {"delay", std::int64_t{1}}});
  bench.add("slow", "streams.decimate", {{"factor", std::int64_t{4}}});
  bench.connect("noise", "sum.in");
  bench.connect("sum", "plant");
  bench.connect("plant", "sum.feedback");
  bench.connect("plant", "slow");
  bench.duration(1.0);
  graph::Limit& plant = bench.limit_input("plant.in");
  plant.min = quantity(-0.4);
  plant.max = quantity(0.4);
  plant.rate = quantity(300.0);
  graph::Limit& slow = bench.limit_input("slow.in");
  slow.max = quantity(0.25);
  const Result result = bench.run();
  REQUIRE(result.outcome.limits[0].violations > 10);
  REQUIRE(result.outcome.limits[1].violations > 10);
  const auto& y = result.stream("plant.out");
  const auto& sums = result.stream("slow.out");
  for (std::size_t k = 0; k < sums.size(); ++k) {
    double sum = 0.0;
    for (std::size_t n = 4 * k; n < 4 * k + 4; ++n) sum += std::min(y[n], 0.25);
    REQUIRE(sums[k] == Approx(sum).margin(1e-14));
  }
  bench.check_identity();
}

TEST_CASE("limits: an input that stops the run lets nothing pass from the violating sample on, whatever the cut") {
  struct Case {
    const char* bound;
    double offset;
    std::size_t position;
    Bound kind;
  };
  for (const Case& one : {Case{"max", 1000.0, 123, Bound::max}, Case{"min", -1000.0, 123, Bound::min},
                          Case{"rate", 20.0, 123, Bound::rate}, Case{"nan", kNan, 123, Bound::finite}}) {
    for (const Cut& cut : kCuts) {
      Line line(one.offset, 123);
      graph::Limit& limit = line.bench.limit_input("actuator.in");
      limit.min = quantity(-500.0);
      limit.max = quantity(900.0);
      limit.rate = quantity(5000.0);
      limit.on_violation = OnViolation::stop;
      std::vector<int> told;
      line.bench.options.violated = [&](int which, const execute::Violation&) { told.push_back(which); };
      const Result result = line.bench.run(cut);
      INFO(one.bound << ", chunk " << cut.chunk << ", threads " << cut.threads << ": " << result.outcome.reason);
      CHECK(result.outcome.status == Outcome::Status::partial);
      CHECK(result.outcome.limit == 0);
      CHECK(result.outcome.failed_block == -1);
      CHECK_FALSE(result.outcome.interrupted);
      CHECK(result.stream("actuator.out").size() == one.position);
      CHECK(result.outcome.limits.at(0).first->position == one.position);
      CHECK(result.outcome.limits[0].first->bound == one.kind);
      const auto latency = static_cast<std::size_t>(result.limits[0].latency_samples);
      CHECK(latency == static_cast<std::size_t>(cut.chunk) * result.threads);
      CHECK(result.stream("disturb.out").size() <= one.position + latency);
      CHECK(told == std::vector<int>{0});
    }
  }
}

TEST_CASE("limits: the end by a limit names signal, value, sample, time and what is allowed") {
  Line line(1000.0, 123);
  graph::Limit& limit = line.bench.limit_input("actuator.in");
  limit.max = quantity(900.0);
  limit.on_violation = OnViolation::stop;
  CHECK(line.bench.run().outcome.reason ==
        "limit violated: actuator.in is 1123 at sample 123 (0.123 s), allowed: at most 900; the run was ended");
}

TEST_CASE("limits: a measured signal ends the run within the plan's latency, and is kept up to the violation") {
  for (const double offset : {1000.0, -1000.0, 50.0, kNan}) {
    for (const std::int64_t chunk : {1, 7, 64, 256}) {
      for (const int threads : {1, 2, 3}) {
        Line line(offset, 250);
        Bench& bench = line.bench;
        bench.add("other", "streams.counter");  // drives an actuator of its own, as fast as its thread may
        bench.add("second", "streams.gain");
        bench.connect("other", "second");
        bench.duration(60.0);
        graph::Limit& limit = bench.limit_output("disturb.out");
        limit.min = quantity(-500.0);
        limit.max = quantity(900.0);
        limit.rate = quantity(5000.0);
        const Result result = bench.run({chunk, threads, 0, 0});
        INFO(offset << ", chunk " << chunk << ", threads " << threads << ": " << result.outcome.reason);
        REQUIRE(result.outcome.limit == 0);
        CHECK(result.outcome.limits.at(0).first->position == 250);
        const auto latency = static_cast<std::size_t>(result.limits.at(0).latency_samples);
        CHECK(latency == static_cast<std::size_t>(chunk) * result.threads);
        CHECK(result.threads == static_cast<std::size_t>(threads));
        CHECK(result.stream("disturb.out").size() == 251);
        CHECK(result.stream("actuator.out").size() <= 250);
        CHECK(result.stream("second.out").size() <= 250 + latency);
      }
    }
  }
}

TEST_CASE("limits: the rate of a measured signal counts from its first sample") {
  Line line(0.0, 0, 1.0);
  line.bench.schedule(0.0, "disturb", "offset", 300.0);
  line.bench.limit_output("disturb.out").rate = quantity(1500.0);
  const Result result = line.bench.run();
  CHECK(result.outcome.status == Outcome::Status::complete);
  CHECK(result.outcome.limits[0].violations == 0);
}

TEST_CASE("limits: a block that is warned of changes nothing, not even what is no number") {
  Line line(kNan, 100);
  graph::Limit& limit = line.bench.limit_input("actuator.in");
  limit.max = quantity(400.0);
  limit.on_violation = OnViolation::warn;
  graph::Limit& measured = line.bench.limit_output("disturb.out");
  measured.max = quantity(400.0);
  measured.on_violation = OnViolation::warn;
  int told = 0;
  line.bench.options.violated = [&](int, const execute::Violation& violation) {
    ++told;
    CHECK(violation.position == 100);
  };
  const Result result = line.bench.run({64, 2, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  CHECK(std::isnan(result.stream("actuator.out")[100]));
  CHECK(result.stream("actuator.out")[499] == 499.0);
  for (const auto& seen : result.outcome.limits) CHECK(seen.violations == 1 + 99);
  CHECK(told == 2);
}

TEST_CASE("limits: those of one signal act in order, each on what the one before leaves") {
  Line line;
  graph::Limit& first = line.bench.limit_input("actuator.in");
  first.max = quantity(200.0);
  graph::Limit& second = line.bench.limit_input("actuator.in");
  second.max = quantity(150.0);
  graph::Limit& third = line.bench.limit_input("actuator.in");
  third.max = quantity(160.0);
  third.on_violation = OnViolation::stop;
  const Result result = line.bench.run({64, 1, 0, 0});
  CHECK(result.outcome.status == Outcome::Status::complete);
  CHECK(result.stream("actuator.out")[499] == 150.0);
  CHECK(result.outcome.limits[0].violations == 299);
  CHECK(result.outcome.limits[1].violations == 349);
  CHECK(result.outcome.limits[1].highest == 200.0);
  CHECK(result.outcome.limits[2].violations == 0);
}

TEST_CASE("limits: a rate of its own begins where the bounds of another limit allow it") {
  for (const bool rate_first : {false, true}) {
    Line line(0.0, 0, 2.0);
    for (const bool rate : {rate_first, !rate_first}) {
      graph::Limit& limit = line.bench.limit_input("actuator.in");
      if (rate)
        limit.rate = quantity(1000.0);
      else
        limit.min = quantity(100.0);
    }
    const Result result = line.bench.run();
    const auto& got = result.stream("actuator.out");
    REQUIRE(got.size() == 500);
    double before = 100.0;
    for (const double y : got) {
      REQUIRE(y >= 100.0);
      REQUIRE(std::abs(y - before) <= 1.0 + 1e-12);
      before = y;
    }
    CHECK(got.back() > 450.0);
  }
}

TEST_CASE("limits: of two that stop a block's run the earlier one does") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("sum", "streams.sum", {{"sign", 1.0}});
  bench.connect("count", "sum.in");
  bench.connect("count", "sum.feedback");
  bench.duration(1.0);
  for (const char* port : {"sum.in", "sum.feedback"}) {
    graph::Limit& limit = bench.limit_input(port);
    limit.max = quantity(port == std::string("sum.in") ? 300.0 : 200.0);
    limit.on_violation = OnViolation::stop;
  }
  graph::Limit& made = bench.limit_output("sum.out");
  made.max = quantity(350.0);
  const Result late = bench.run({1024, 1, 0, 0});
  CHECK(late.outcome.limit == 2);  // 2 n > 350 at n = 176
  CHECK(late.stream("sum.out").size() == 177);
  bench.phase.limits.pop_back();
  const Result result = bench.run({1024, 1, 0, 0});
  CHECK(result.outcome.limit == 1);
  CHECK(result.stream("sum.out").size() == 201);
}

TEST_CASE("limits: blocks are deactivated once and do not finish") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("device", "faults.fault");
  bench.add("behind", "faults.fault");
  bench.connect("count", "device");
  bench.connect("device", "behind");
  bench.duration(10.0);
  bench.limit_output("device.out").max = quantity(100.0);
  for (const int threads : {1, 2}) {
    const Result result = bench.run({16, threads, 0, 0});
    CHECK(result.outcome.limit == 0);
    for (const char* block : {"device", "behind"})
      CHECK(result.said(block) == std::vector<std::string>{"activate", "deactivate"});
  }
}

TEST_CASE("limits: a device is deactivated while an asynchronous block still computes") {
  int pipe_ends[2] = {-1, -1};
  REQUIRE(pipe(pipe_ends) == 0);
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("device", "faults.fault", {{"tells", std::int64_t{pipe_ends[1]}}});
  bench.add("pulse", "messages.pulse", {{"rate", 1000.0}});
  bench.add("identify", "faults.ponder", {{"release", std::int64_t{pipe_ends[0]}}});  // until the device is left
  bench.connect("count", "device");
  bench.tell("pulse", "identify");
  bench.duration(10.0);
  bench.limit_output("device.out").max = quantity(100.0);
  const Result result = bench.run({16, 1, 0, 0});
  CHECK(result.outcome.limit == 0);
  CHECK_FALSE(result.outcome.hung);
  CHECK(result.said("device") == std::vector<std::string>{"activate", "deactivate"});
  for (const int end : pipe_ends) close(end);
}

}  // namespace
}  // namespace bodeflow::test
