#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Rate;
using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;
using bodeflow::test::Stream;
using Complex = std::complex<double>;

namespace {

/// offset + sum of two cosines of 50 Hz and 120 Hz at 1 kHz.
std::vector<double> samples(std::size_t count) {
  std::vector<double> x;
  for (std::size_t n = 0; n < count; ++n) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(n) / 1000.0;
    x.push_back(7.0 + 1.5 * std::cos(50.0 * t + 0.3) + 0.2 * std::cos(120.0 * t - 1.0));
  }
  return x;
}

Complex value(const Channels& out, std::size_t channel, std::size_t n) { return {out[channel][2 * n], out[channel][2 * n + 1]}; }

LoadedBlock& given(LoadedBlock& block, std::vector<double> frequencies, std::int64_t window, std::int64_t hop) {
  return block.set("frequencies", frequencies).set("window", window).set("hop", hop);
}

}  // namespace

TEST_CASE("goertzel: amplitude and phase of each frequency and channel, constant in a steady state") {
  const auto x = samples(1000);
  std::vector<double> half = x;
  for (double& v : half) v *= -0.5;
  for (const std::int64_t hop : {1, 4, 20, 100}) {
    LoadedBlock block("spectrum.goertzel");
    given(block, {50.0, 120.0, 200.0}, 100, hop).feed({Stream::with({x, half})}).start();
    const auto& facts = block.resolve();
    CHECK(facts[0].channels == 6);
    CHECK(facts[0].element == BF_C64);
    CHECK(facts[0].rate == Rate(1000, hop));
    CHECK(facts[0].channel_names[4] == "in_2 at 120 Hz");
    const auto out = block.run(static_cast<std::uint64_t>(1000 / hop));
    for (std::size_t n = static_cast<std::size_t>(100 / hop) - 1; n < static_cast<std::size_t>(1000 / hop); ++n) {
      CHECK(std::abs(value(out, 0, n) - std::polar(1.5, 0.3)) < 1e-13);
      CHECK(std::abs(value(out, 1, n) - std::polar(0.2, -1.0)) < 1e-13);
      CHECK(std::abs(value(out, 2, n)) < 1e-13);
      CHECK(std::abs(value(out, 3, n) + std::polar(0.75, 0.3)) < 1e-13);
    }
  }
}

TEST_CASE("goertzel: the first values know the samples before the first as zeros") {
  LoadedBlock block("spectrum.goertzel");
  std::vector<double> x(40);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::cos(2.0 * std::numbers::pi * 0.1 * static_cast<double>(n));
  given(block, {100.0}, 20, 10).feed({Stream::of(x)}).start();
  const auto out = block.run(4);
  CHECK(std::abs(value(out, 0, 0) - 0.5) < 1e-15);
  for (std::size_t n = 1; n < 4; ++n) CHECK(std::abs(value(out, 0, n) - 1.0) < 1e-15);
}

TEST_CASE("goertzel: the chunks do not show in the bits") {
  bodeflow::numerics::Random random(3);
  std::vector<double> x(6000);
  for (double& v : x) v = random.normal();
  const auto run = [&](std::uint64_t chunk) {
    LoadedBlock block("spectrum.goertzel");
    return given(block, {30.0, 70.0, 330.0}, 300, 3).feed({Stream::with({x, x})}).start().run(2000, chunk);
  };
  const auto whole = run(2000);
  for (const std::uint64_t chunk : {1u, 7u, 64u, 999u}) CHECK(run(chunk) == whole);
}

TEST_CASE("goertzel: a value depends on the newest two windows only, to the bit: no drift, however long the stream") {
  bodeflow::numerics::Random random(3);
  std::vector<double> late(1000), all;
  for (double& v : late) v = random.normal();
  for (int n = 0; n < 400'000; ++n) all.push_back(1e9 * random.normal());
  all.insert(all.end(), late.begin(), late.end());
  LoadedBlock fresh("spectrum.goertzel"), used("spectrum.goertzel");
  const auto after_start = given(fresh, {20.0, 330.0}, 100, 5).feed({Stream::of(late)}).start().run(200);
  const auto after_storm = given(used, {20.0, 330.0}, 100, 5).feed({Stream::of(all)}).start().run(all.size() / 5);
  const std::size_t shift = after_storm[0].size() - after_start[0].size();
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 2 * 2 * 20; i < after_start[c].size(); ++i) REQUIRE(after_storm[c][shift + i] == after_start[c][i]);
  }
}

TEST_CASE("goertzel: frequencies that do not fit the window are refused with the nearest that does") {
  const auto refusal = [](std::vector<double> frequencies, std::int64_t window, std::int64_t hop) {
    return refusal_of([&] {
      LoadedBlock block("spectrum.goertzel");
      given(block, frequencies, window, hop).feed({Stream::of(std::vector<double>(100))}).start();
    });
  };
  CHECK(refusal({49.7}, 100, 1) == "frequency 49.7 Hz is 4.97 cycles in a window of 100 samples; nearest whole: 50 Hz");
  CHECK(
      refusal({500.0}, 100, 1) ==
      "frequency 500 Hz with a window of 100 samples at 1000 Hz; allowed: 10 Hz and its multiples below half of the sample rate");
  CHECK(refusal({1.0}, 100, 1) ==
        "frequency 1 Hz with a window of 100 samples at 1000 Hz; allowed: 10 Hz and its multiples below half of the sample rate");
  CHECK(refusal({50.0}, 100, 7) == "hop 7 does not divide the window of 100 samples");
  CHECK(refusal({}, 100, 1) == "frequencies is empty");
}

TEST_CASE("goertzel: a sample that is not finite ends the run by name") {
  auto x = samples(200);
  x[133] = std::numeric_limits<double>::infinity();
  LoadedBlock block("spectrum.goertzel");
  given(block, {50.0}, 100, 1).feed({Stream::of(x)}).start();
  block.run(100);
  CHECK(refusal_of([&] { block.run(100, 30); }) == "channel 1: sample 133 is infinite");
}
