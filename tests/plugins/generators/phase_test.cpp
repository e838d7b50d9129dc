#include "phase.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"

using bodeflow::Rate;
using bodeflow::generators::Phase;
using bodeflow::generators::sine_of_cycles;

TEST_CASE("the sine of a fraction of a cycle is off by less than 4e-16") {
  for (int k = -50000; k <= 50000; ++k) {
    const double x = k * 1e-5;
    const auto exact = static_cast<double>(std::sin(2 * std::numbers::pi_v<long double> * static_cast<long double>(x)));
    REQUIRE(std::abs(sine_of_cycles(x) - exact) < 4e-16);
  }
  CHECK(sine_of_cycles(0.0) == 0.0);
  CHECK(std::abs(sine_of_cycles(0.25) - 1.0) < 2e-16);
  CHECK(sine_of_cycles(-0.25) == -sine_of_cycles(0.25));
  CHECK(sine_of_cycles(0.5) == 0.0);
  CHECK(sine_of_cycles(-0.5) == 0.0);
}

TEST_CASE("a step is the frequency over the rate to the last of 128 places") {
  CHECK(Phase::step(50, {250, 1}).cycles() == 0.2);
  CHECK(Phase::step(1, {3, 1}).cycles() == 1.0 / 3.0);
  CHECK(Phase::step(0, {250, 1}).cycles() == 0.0);
  CHECK(Phase::step(125, {250, 1}).times(2).cycles() == 0.0);
  // 44100/7 Hz against 3/7 of it: the denominators cancel.
  CHECK(Phase::step(2700, {44100, 7}).times(7).cycles() == 0.0);
  CHECK(Phase::step(1e-30, {1, 1}).times(1000000000000ull).cycles() == Approx(1e-18).margin(6e-20));
  CHECK(Phase::step(1e-60, {1, 1}).cycles() == 0.0);
}

TEST_CASE("whole periods end where they began, after 1e8 and 1e18 samples") {
  // 0.1 is not a binary fraction: its own error counts 1e17 times, that of the accumulator does not show.
  for (const std::uint64_t periods : {10000000ull, 100000000000000000ull}) {
    const Phase turned = Phase::step(50, {500, 1}).times(periods * 10);
    CHECK(std::abs(turned.cycles()) < 1e-19);
  }
}

TEST_CASE("radians become cycles") {
  CHECK(Phase::from_radians(std::numbers::pi / 2).cycles() == 0.25);
  CHECK(Phase::from_radians(-std::numbers::pi / 2).cycles() == -0.25);
  CHECK(Phase::from_radians(6 * std::numbers::pi).cycles() == Approx(0.0).margin(1e-15));
  CHECK(std::abs(Phase::from_radians(-1e-300).cycles()) < 1e-19);
}
