#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

using List = std::vector<double>;

}  // namespace

TEST_CASE("a step begins at the first sample at or after its time") {
  for (const auto& [time, first] : {std::pair{0.0, 0}, {0.001, 1}, {0.0011, 2}, {1.1, 1100}, {0.7, 700}}) {
    LoadedBlock block("generators.step");
    block.set("sample_rate", 1e3).set("time", time).set("amplitude", 3.0).set("offset", -1.0).start();
    const auto y = block.run(1200, 77)[0];
    for (int n = 0; n < 1200; ++n) REQUIRE(y[static_cast<std::size_t>(n)] == (n < first ? -1.0 : 2.0));
  }
}

TEST_CASE("the height of a step changes while it runs") {
  LoadedBlock block("generators.step");
  block.set("sample_rate", 1e3).start();
  CHECK(block.run(2)[0] == List{1, 1});
  block.change("amplitude", 5.0);
  CHECK(block.run(2)[0] == List{5, 5});
}

TEST_CASE("a ramp rises with its slope for its duration") {
  LoadedBlock block("generators.ramp"), endless("generators.ramp");
  block.set("sample_rate", 10.0).set("time", 0.25).set("slope", 4.0).set("duration", 0.5).set("offset", 1.0).start();
  const List expected = {1, 1, 1, 1.2, 1.6, 2, 2.4, 2.8, 3, 3};
  const auto y = block.run(10, 3)[0];
  for (std::size_t n = 0; n < 10; ++n) CHECK(y[n] == Approx(expected[n]));
  endless.set("sample_rate", 10.0).set("slope", -1.0).start();
  CHECK(endless.run(101)[0].back() == Approx(-10));
}

TEST_CASE("pulses have their times, widths and amplitudes, and repeat with their period") {
  LoadedBlock block("generators.pulses");
  block.set("sample_rate", 10.0).set("times", List{0.1, 0.5}).set("widths", List{0.2, 0.25}).set("amplitudes", List{1, -2});
  block.set("offset", 0.5).set("period", 1.0).start();
  const List cycle = {0.5, 1.5, 1.5, 0.5, 0.5, -1.5, -1.5, -1.5, 0.5, 0.5};
  const auto y = block.run(35, 4)[0];
  for (std::size_t n = 0; n < 35; ++n) CHECK(y[n] == cycle[n % 10]);
  CHECK(block.resolve()[0].notes.at("excitation.period") == List{1});

  LoadedBlock once("generators.pulses");
  once.set("sample_rate", 10.0).set("times", List{0}).set("widths", List{0.1}).start();
  CHECK(once.run(4)[0] == List{1, 0, 0, 0});
  CHECK(once.run(1000)[0] == List(1000, 0.0));
}

TEST_CASE("pulses that overlap, hold no sample or do not fit their period are refused") {
  const auto refused = [](const List& times, const List& widths, double period) {
    LoadedBlock block("generators.pulses");
    block.set("sample_rate", 10.0).set("times", times).set("widths", widths);
    if (period > 0) block.set("period", period);
    return refusal_of([&] { block.configure(); });
  };
  CHECK(refused({}, {1}, 0) == "times is empty");
  CHECK(refused({0, 1}, {1, 2, 3}, 0) == "widths has 3 values, allowed: 1, or one for each of the 2 times");
  CHECK(refused({0, 1}, {1.5}, 0) == "pulse 2 at 1 s begins before the pulse ahead of it has ended");
  CHECK(refused({1, 0}, {0.5}, 0) == "pulse 2 at 0 s begins before the pulse ahead of it has ended");
  CHECK(refused({0.11}, {0.05}, 0) == "pulse 1 at 0.11 s with a width of 0.05 s holds no sample; samples are 0.1 s apart");
  CHECK(refused({0, 1}, {0.5}, 1.2) == "period is 1.2 s, but the last pulse ends after it");
  CHECK(refused({0}, {0.5}, 1.23) == "period is 1.23 s, no whole number of samples; near it: 1.3 s");
}
