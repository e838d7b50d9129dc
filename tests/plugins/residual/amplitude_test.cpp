#include "blocks/amplitude.hpp"

#include <cmath>

#include "catch.hpp"
#include "simple_bench.hpp"

using namespace bodeflow::residual;

TEST_CASE("amplitude: as large as the wanted signal-to-noise ratio needs") {
  const auto pilot = bench::record({}, 1.0, 1, 3);
  const AmplitudeChoice c = choose_amplitude(pilot, 1.0, {40.0, 1e6, 1e6, 0.8}).value();
  CHECK(c.limited_by == "signal_to_noise");
  CHECK(c.noise_std == Approx(0.1).epsilon(0.1));
  const auto checked = choose_amplitude(bench::record({}, c.amplitude, 2, 3), c.amplitude, {40.0, 1e6, 1e6, 0.8}).value();
  CHECK(checked.signal_to_noise_db == Approx(40.0).margin(1.0));
}

TEST_CASE("amplitude: stays below the limits by the margin") {
  const auto pilot = bench::record({}, 4.0, 1, 3);
  const AmplitudeChoice by_input = choose_amplitude(pilot, 4.0, {60.0, 100.0, 1e6, 0.5}).value();
  CHECK(by_input.limited_by == "largest_input");
  CHECK(by_input.factor * by_input.input_peak == Approx(50.0));
  const AmplitudeChoice by_output = choose_amplitude(pilot, 4.0, {60.0, 1e6, 10.0, 0.8}).value();
  CHECK(by_output.limited_by == "largest_output");
  CHECK(by_output.factor * by_output.output_peak == Approx(8.0));
  CHECK(by_output.amplitude == Approx(4.0 * by_output.factor));
}
