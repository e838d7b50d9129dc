#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "plugins/loaded_block.hpp"
#include "sweep.hpp"

using bodeflow::Rate;
using bodeflow::generators::Sweep;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

constexpr long double kTurn = 2 * std::numbers::pi_v<long double>;

double sine(long double cycles) { return static_cast<double>(std::sin(kTurn * (cycles - std::floor(cycles)))); }

LoadedBlock& given(LoadedBlock& block, double from, double to, std::int64_t period, const char* law) {
  return block.set("sample_rate", 1e4).set("from", from).set("to", to).set("period", period).set("sweep", law);
}

}  // namespace

TEST_CASE("a linear chirp is sin of 2 pi (f1 t + (f2 - f1) t^2 / 2T), rising or falling") {
  for (const auto& [from, to] : {std::pair{10.0, 4000.0}, std::pair{4000.0, 10.0}, std::pair{100.0, 100.0}}) {
    LoadedBlock block("generators.chirp");
    given(block, from, to, 10000, "linear").start();
    const auto y = block.run(10000, 333)[0];
    for (std::size_t n = 0; n < y.size(); ++n) {
      const long double t = static_cast<long double>(n) / 10000;
      REQUIRE(std::abs(y[n] - sine(from * t + (to - from) * t * t / 2)) < 1e-13);
    }
  }
}

TEST_CASE("a logarithmic chirp passes each octave in the same time") {
  LoadedBlock block("generators.chirp");
  given(block, 10, 2560, 8000, "logarithmic").start();
  const auto y = block.run(8000, 100)[0];
  const long double scale = 10 * 0.8L / std::log(256.0L);
  for (std::size_t n = 0; n < y.size(); ++n)
    REQUIRE(std::abs(y[n] - sine(scale * (std::pow(256.0L, static_cast<long double>(n) / 8000) - 1))) < 1e-11);
  // Frequency from the phase: doubled after each eighth of the sweep.
  const Sweep sweep(Sweep::Law::logarithmic, 10, 2560, 8000, Rate(10000, 1));
  for (int octave = 0; octave < 8; ++octave) {
    const auto n = static_cast<std::uint64_t>(1000 * octave + 500);
    const double step = sweep.cycles(n + 1) - sweep.cycles(n - 1);
    CHECK((step - std::floor(step)) * 5000 == Approx(10 * std::pow(2.0, octave + 0.5)).epsilon(1e-6));
  }
}

TEST_CASE("the phase of a linear chirp stays exact over 4e9 samples") {
  // f1 = 0, f2 = rate / 4 over 2^32 samples: n^2 / 2^35 cycles, exact in whole numbers.
  const Sweep sweep(Sweep::Law::linear, 0, 250, std::uint64_t{1} << 32, Rate(1000, 1));
  for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{123456789}, std::uint64_t{4294967295}}) {
    const std::uint64_t rest = n * n & ((std::uint64_t{1} << 35) - 1);
    const double cycles = std::ldexp(static_cast<double>(rest), -35);
    CHECK(std::abs(std::remainder(sweep.cycles(n) - cycles, 1.0)) < 1e-16);
  }
}

TEST_CASE("a chirp repeats with its period, ends after its periods, or stays at its offset after one sweep") {
  LoadedBlock periodic("generators.chirp"), once("generators.chirp");
  given(periodic, 100, 300, 500, "linear").set("periods", std::int64_t{3}).start();
  CHECK(periodic.resolve()[0].length == 1500);
  const auto y = periodic.run(5000, 64)[0];
  REQUIRE(y.size() == 1500);
  for (std::size_t n = 500; n < 1500; ++n) REQUIRE(y[n] == y[n - 500]);

  given(once, 100, 300, 500, "linear").set("repeat", false).set("offset", 2.0).start();
  const auto x = once.run(1000, 64)[0];
  for (std::size_t n = 0; n < 500; ++n) REQUIRE(x[n] == Approx(2 + y[n]));
  for (std::size_t n = 500; n < 1000; ++n) REQUIRE(x[n] == 2.0);
}

TEST_CASE("a chirp tells its crest factor and the lines of its period") {
  LoadedBlock block("generators.chirp");
  given(block, 100, 300, 10000, "linear").configure();
  const auto notes = block.resolve()[0].notes;
  CHECK(notes.at("excitation.period") == std::vector<double>{1});
  CHECK(notes.at("excitation.crest_factor")[0] == Approx(std::sqrt(2.0)).epsilon(0.01));
  // The power is within the band: sum of squares over the lines inside.
  const auto& lines = notes.at("excitation.frequencies");
  const auto& amplitudes = notes.at("excitation.amplitudes");
  double inside = 0, all = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    all += amplitudes[i] * amplitudes[i];
    if (lines[i] >= 95 && lines[i] <= 305) inside += amplitudes[i] * amplitudes[i];
  }
  CHECK(inside > 0.98 * all);
  CHECK(all == Approx(1.0).epsilon(0.01));
}

TEST_CASE("chirps beyond half of the sample rate, and logarithmic ones from zero, are refused") {
  LoadedBlock fast("generators.chirp"), zero("generators.chirp");
  CHECK(refusal_of([&] { given(fast, 10, 5001, 100, "linear").configure(); }) ==
        "to is 5001 Hz, allowed: at most half of the sample rate, 5000 Hz");
  CHECK(refusal_of([&] { given(zero, 0, 500, 100, "logarithmic").configure(); }) ==
        "from is 0 Hz, allowed: above zero for a logarithmic sweep");
}
