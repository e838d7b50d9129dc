#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

TEST_CASE("streams: a chain of blocks gives what the formula says") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain", {{"gain", 3.0}, {"offset", 0.5}});
  bench.add("sums", "streams.decimate", {{"factor", std::int64_t{4}}});
  bench.connect("count", "gain");
  bench.connect("gain", "sums");
  bench.duration(1.0);
  for (const int threads : {1, 3}) {
    const Result result = bench.run({64, threads, 0, 0});
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    REQUIRE(result.stream("gain.out").size() == 1000);
    REQUIRE(result.stream("sums.out").size() == 250);
    for (std::size_t n = 0; n < 1000; ++n) CHECK(result.stream("gain.out")[n] == 3.0 * static_cast<double>(n) + 0.5);
    for (std::size_t k = 0; k < 250; ++k) CHECK(result.stream("sums.out")[k] == 3.0 * static_cast<double>(16 * k + 6) + 2.0);
    CHECK(result.outcome.time_s == Approx(1.0));
    CHECK(result.outcome.metrics[1].firings == 1000);
    CHECK(result.outcome.metrics[1].calls == 17);  // 16 chunks and finish
    CHECK(result.outcome.metrics[1].dropped == 0);
  }
}

TEST_CASE("streams: a delayed input sees the initial values first, whatever the delay is against the chunk") {
  for (const std::int64_t delay : {1, 3, 20, 150}) {
    std::vector<double> initial;
    for (std::int64_t i = 0; i < delay; ++i) initial.push_back(-1.0 - static_cast<double>(i));
    Bench bench;
    bench.add("count", "streams.counter");
    bench.add("delayed", "streams.pole", {{"pole", 0.0}, {"delay", delay}, {"initial", initial}});
    bench.add("zeros", "streams.pole", {{"pole", 0.0}, {"delay", delay}});
    bench.connect("count", "delayed");
    bench.connect("count", "zeros");
    bench.duration(0.2);
    for (const Cut& cut : {Cut{64, 1, 0, 0}, Cut{7, 1, 3, 2}, Cut{64, 2, 0, 0}, Cut{7, 3, 2, 0}}) {
      const Result result = bench.run(cut);
      REQUIRE(result.outcome.status == Outcome::Status::complete);
      const auto &y = result.stream("delayed.out"), &z = result.stream("zeros.out");
      REQUIRE(y.size() == 200);
      for (std::int64_t n = 0; n < 200; ++n) {
        const auto i = static_cast<std::size_t>(n);
        CHECK(y[i] == (n < delay ? initial[i] : static_cast<double>(n - delay)));
        CHECK(z[i] == (n < delay ? 0.0 : static_cast<double>(n - delay)));
      }
      CHECK(result.outcome.metrics[1].dropped == 0);
    }
  }
}

TEST_CASE("streams: a single-rate loop computes its difference equation") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("sum", "streams.sum");
  bench.add("gain", "streams.gain", {{"gain", 0.25}});
  bench.add("plant", "streams.pole", {{"pole", 0.9}, {"delay", std::int64_t{1}}, {"initial", std::vector<double>{2.0}}});
  bench.connect("count", "sum.in");
  bench.connect("plant", "sum.feedback");
  bench.connect("sum", "gain");
  bench.connect("gain", "plant");
  bench.duration(0.5);
  const Result result = bench.run({100, 1, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  double input = 2.0, state = 0.0;
  for (std::size_t n = 0; n < 500; ++n) {
    state = 0.9 * state + input;
    input = 0.25 * (static_cast<double>(n) - state);
    CHECK(result.stream("plant.out")[n] == state);
    CHECK(result.stream("gain.out")[n] == input);
  }
}

TEST_CASE("streams: readers in one loop with different initial values each see their own") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("sum", "streams.sum");
  bench.add("a", "streams.pole", {{"pole", 0.0}, {"delay", std::int64_t{2}}, {"initial", std::vector<double>{5.0, 6.0}}});
  bench.add("b", "streams.pole", {{"pole", 0.0}, {"delay", std::int64_t{2}}, {"initial", std::vector<double>{7.0, 8.0}}});
  bench.add("c", "streams.pole", {{"pole", 0.0}, {"delay", std::int64_t{1}}, {"initial", std::vector<double>{9.0}}});
  bench.add("both", "streams.sum", {{"sign", 1.0}});
  bench.connect("count", "sum.in");
  bench.connect("sum", "a");
  bench.connect("sum", "b");
  bench.connect("sum", "c");
  bench.connect("a", "both.in");
  bench.connect("b", "both.feedback");
  bench.connect("both", "sum.feedback");
  bench.duration(0.1);
  for (const Cut& cut : {Cut{64, 1, 0, 0}, Cut{16, 1, 5, 1}, Cut{16, 2, 0, 0}}) {
    const Result result = bench.run(cut);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    std::vector<double> x;
    for (std::size_t n = 0; n < 100; ++n) {
      const double a = n < 2 ? 5.0 + static_cast<double>(n) : x[n - 2], b = n < 2 ? 7.0 + static_cast<double>(n) : x[n - 2];
      x.push_back(static_cast<double>(n) - (a + b));
      CHECK(result.stream("sum.out")[n] == x[n]);
      CHECK(result.stream("c.out")[n] == (n < 1 ? 9.0 : x[n - 1]));
    }
  }
}

TEST_CASE("streams: samples of all channels pass a ring between threads") {
  Bench bench;
  bench.add("noise", "streams.noise", {{"channels", std::int64_t{3}}});
  bench.add("pole", "streams.pole", {{"pole", 0.0}, {"delay", std::int64_t{5}}});
  bench.connect("noise", "pole");
  bench.duration(3.0);
  const Result result = bench.run({32, 2, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  const auto &x = result.streams.at("noise.out"), &y = result.streams.at("pole.out");
  REQUIRE(y.size() == 3);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t n = 5; n < 3000; ++n) REQUIRE(y[c][n] == x[c][n - 5]);
  CHECK(x[0][0] != x[1][0]);
}

}  // namespace
}  // namespace bodeflow::test
