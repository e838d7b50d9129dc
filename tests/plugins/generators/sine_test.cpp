#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Rate;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

LoadedBlock& given(LoadedBlock& block, double rate, double frequency) {
  return block.set("sample_rate", rate).set("frequency", frequency);
}

// With the angle reduced in whole numbers: numerator/denominator cycles a sample.
double exact(std::int64_t n, std::int64_t numerator, std::int64_t denominator, double phase) {
  const auto turned = static_cast<long double>((n % denominator) * (numerator % denominator) % denominator) /
                      static_cast<long double>(denominator);
  return static_cast<double>(std::sin(2 * std::numbers::pi_v<long double> * turned + static_cast<long double>(phase)));
}

}  // namespace

TEST_CASE("a sine has its frequency, amplitude, phase, offset, rate and unit") {
  LoadedBlock block("generators.sine");
  given(block, 1000, 70).set("amplitude", 3.0).set("phase", 0.5).set("offset", 2.0).set("unit", "V").start();
  const auto& facts = block.resolve();
  CHECK(facts[0].known);
  CHECK(facts[0].channels == 1);
  CHECK(facts[0].rate == Rate(1000, 1));
  CHECK(facts[0].length == -1);
  CHECK(facts[0].unit == "V");
  const auto y = block.run(1000)[0];
  for (std::int64_t n = 0; n < 1000; ++n)
    REQUIRE(std::abs(y[static_cast<std::size_t>(n)] - 2 - 3 * exact(n, 7, 100, 0.5)) < 2e-15);
}

namespace {

// The largest error of 100 samples after `calls` of a million samples each.
double error_after(int calls) {
  LoadedBlock block("generators.sine");
  given(block, 44100, 440).start(1000000);
  for (int call = 0; call < calls; ++call) block.run(1000000, 1000000);
  const auto y = block.run(100)[0];
  double largest = 0;
  for (std::int64_t n = 0; n < 100; ++n) {
    largest = std::max(largest, std::abs(y[static_cast<std::size_t>(n)] - exact(calls * 1000000ll + n, 22, 2205, 0)));
  }
  return largest;
}

}  // namespace

TEST_CASE("a sine at sample 1e7 is as exact as at sample 1") { CHECK(error_after(10) < 5e-16); }

TEST_CASE("a sine at sample 1e8 is as exact as at sample 1", "[long]") { CHECK(error_after(100) < 5e-16); }

TEST_CASE("the chunks of a sine do not show in its bits") {
  LoadedBlock whole("generators.sine"), cut("generators.sine");
  given(whole, 48000, 1234.5678).start();
  given(cut, 48000, 1234.5678).start();
  CHECK(whole.run(3000, 1024) == cut.run(3000, 7));
}

TEST_CASE("a live change of frequency keeps the phase") {
  LoadedBlock block("generators.sine");
  given(block, 1000, 10).start();
  block.run(130);  // 1.3 cycles
  block.change("frequency", 40.0);
  block.change("amplitude", 2.0);
  const auto y = block.run(50)[0];
  for (int n = 0; n < 50; ++n) {
    const double cycles = 0.3 + 0.04 * n;
    CHECK(std::abs(y[static_cast<std::size_t>(n)] - 2 * std::sin(2 * std::numbers::pi * cycles)) < 1e-14);
  }
}

TEST_CASE("reset brings a sine back to its start with the parameters of the graph") {
  LoadedBlock block("generators.sine");
  given(block, 1000, 10).start();
  const auto first = block.run(100);
  block.change("frequency", 40.0);
  block.run(33);
  block.reset();
  CHECK(block.run(100) == first);
}

TEST_CASE("a frequency beyond half of the sample rate is refused, at the start and while running") {
  LoadedBlock block("generators.sine");
  CHECK(refusal_of([&] { given(block, 250, 125.5).start(); }) ==
        "frequency is 125.5 Hz, allowed: at most half of the sample rate, 125 Hz");
  given(block, 250, 125).start();
  CHECK(refusal_of([&] { block.change("frequency", 200.0); }) ==
        "frequency is 200 Hz, allowed: at most half of the sample rate, 125 Hz");
}
