#include "frequency_steps.hpp"

#include <cmath>
#include <numeric>

#include "catch.hpp"

using namespace bodeflow;
using namespace bodeflow::generators;

TEST_CASE("a frequency that fits the samples is placed where it is") {
  const auto step = place_frequency(50.0, Rate(1000, 1), 1e-3).value();
  CHECK(step.cycles == 1);
  CHECK(step.window == 20);
  CHECK(step.frequency_hz(Rate(1000, 1)) == 50.0);
}

TEST_CASE("a frequency between the whole periods takes the fewest cycles within the tolerance") {
  // 1000/300 = 3.33 samples a cycle: three cycles are 10 samples.
  const auto step = place_frequency(300.0, Rate(1000, 1), 1e-3).value();
  CHECK(step.cycles == 3);
  CHECK(step.window == 10);
  const auto coarse = place_frequency(300.0, Rate(1000, 1), 0.1).value();
  CHECK(coarse.cycles == 2);  // one cycle in 3 samples would be 11 % too high
  CHECK(coarse.window == 7);
}

TEST_CASE("every placed frequency is within the tolerance, below half of the rate and reduced to lowest terms") {
  const Rate rate(44100, 1);
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    for (const double wanted : frequency_grid(0.7, 20000.0, 150, true)) {
      const auto step = place_frequency(wanted, rate, tolerance).value();
      INFO(wanted << " " << tolerance);
      CHECK(std::abs(step.frequency_hz(rate) / wanted - 1.0) <= tolerance * (1.0 + 1e-9));
      CHECK(step.window > 2 * step.cycles);
      CHECK(std::gcd(step.window, step.cycles) == 1);
      CHECK(static_cast<double>(step.window) <= 0.5 / tolerance + rate.hz() / wanted + 1.0);
    }
  }
}

TEST_CASE("frequencies that cannot be placed are refused by name") {
  const Rate rate(1000, 1);
  CHECK(place_frequency(500.0, rate, 1e-3).error().text ==
        "frequency 500 Hz; allowed: above 0 and below half of the sample rate, 500 Hz");
  CHECK(place_frequency(-1.0, rate, 1e-3).error().text ==
        "frequency -1 Hz; allowed: above 0 and below half of the sample rate, 500 Hz");
  CHECK(place_frequency(1e-6, rate, 1e-3).error().text ==
        "frequency 1e-06 Hz needs a window of 1000000000 samples; allowed: 100000000; lower the sample rate or raise the "
        "tolerance");
  CHECK(place_frequencies({10.0, 20.0, 10.001}, rate, 1e-3).error().text ==
        "frequencies 10 Hz and 10.001 Hz both fall on 10 Hz, 1 cycles in 100 samples; lower the tolerance");
}

TEST_CASE("a grid of frequencies has its ends exactly and even ratios or distances") {
  const auto ratios = frequency_grid(0.5, 20.0, 60, true);
  REQUIRE(ratios.size() == 60);
  CHECK(ratios.front() == 0.5);
  CHECK(ratios.back() == 20.0);
  for (std::size_t k = 1; k < 60; ++k) CHECK(ratios[k] / ratios[k - 1] == Approx(std::pow(40.0, 1.0 / 59.0)).epsilon(1e-12));
  CHECK(frequency_grid(30.0, 10.0, 3, false) == std::vector<double>{30.0, 20.0, 10.0});
  CHECK(frequency_grid(7.0, 9.0, 1, true) == std::vector<double>{7.0});
}
