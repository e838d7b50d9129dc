#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

TEST_CASE("a square wave of a period in samples has the same cycle for ever, with the duty in whole samples") {
  LoadedBlock block("generators.square");
  block.set("sample_rate", 1e3).set("period", std::int64_t{7}).set("duty", 0.4).set("amplitude", 2.0).set("offset", 1.0).start();
  const auto y = block.run(7000, 64)[0];
  for (std::size_t n = 0; n < y.size(); ++n) REQUIRE(y[n] == (n % 7 < 3 ? 3.0 : -1.0));
}

TEST_CASE("every period from 2 samples on has at least one high and one low sample") {
  for (const std::int64_t period : {2, 3, 6, 10, 49, 1000, 1023}) {
    for (const double duty : {1e-6, 0.5, 1 - 1e-6}) {
      LoadedBlock block("generators.square");
      block.set("sample_rate", 44100.0).set("period", period).set("duty", duty).start();
      const auto high = static_cast<std::size_t>(
          std::clamp<double>(std::round(duty * static_cast<double>(period)), 1, static_cast<double>(period - 1)));
      const auto y = block.run(static_cast<std::uint64_t>(3 * period))[0];
      for (std::size_t n = 0; n < y.size(); ++n) REQUIRE(y[n] == (n % static_cast<std::size_t>(period) < high ? 1.0 : -1.0));
    }
  }
}

TEST_CASE("the frequency of a square wave is exact: a third of the rate keeps its edges, an odd ratio its mean") {
  LoadedBlock third("generators.square");
  third.set("sample_rate", 48000.0).set("frequency", 16000.0).start();
  const auto y = third.run(300000, 4096)[0];
  for (std::size_t n = 0; n < y.size(); ++n) REQUIRE(y[n] == (n % 3 < 2 ? 1.0 : -1.0));

  LoadedBlock odd("generators.square");
  odd.set("sample_rate", 1000.0).set("frequency", 7.3).start();
  const auto x = odd.run(1000000, 4096)[0];
  std::size_t rising = 0;
  for (std::size_t n = 1; n < x.size(); ++n) rising += x[n] > x[n - 1] ? 1 : 0;
  CHECK(rising == 7299);  // 7300 cycles, the first begins high
}

TEST_CASE("a live change of a square wave keeps its phase") {
  LoadedBlock block("generators.square");
  block.set("sample_rate", 1e3).set("frequency", 10.0).start();
  block.run(25);  // a quarter of a cycle
  block.change("frequency", 20.0);
  const auto y = block.run(50)[0];
  // The high part has another quarter, 12.5 samples.
  for (std::size_t n = 0; n < 50; ++n) CHECK(y[n] == (n < 13 || n >= 38 ? 1.0 : -1.0));
}

TEST_CASE("a periodic square wave tells its odd lines") {
  LoadedBlock block("generators.square");
  block.set("sample_rate", 100.0).set("period", std::int64_t{10}).configure();
  const auto notes = block.resolve()[0].notes;
  CHECK(notes.at("excitation.period") == std::vector<double>{0.1});
  CHECK(notes.at("excitation.frequencies") == std::vector<double>{10, 30, 50});
  CHECK(notes.at("excitation.amplitudes")[0] == Approx(0.4 / std::sin(std::numbers::pi / 10)));
  CHECK(notes.at("excitation.amplitudes")[2] == Approx(0.2));
  CHECK(notes.at("excitation.crest_factor")[0] == Approx(1.0));
}

TEST_CASE("a square wave without or with two frequencies, or a duty beyond its limits, is refused") {
  LoadedBlock neither("generators.square"), both("generators.square"), fast("generators.square"), duty("generators.square");
  CHECK(refusal_of([&] { neither.set("sample_rate", 1e3).configure(); }) == "one of frequency and period must be given");
  CHECK(refusal_of([&] { both.set("sample_rate", 1e3).set("frequency", 1.0).set("period", std::int64_t{9}).configure(); }) ==
        "one of frequency and period must be given");
  CHECK(refusal_of([&] { fast.set("sample_rate", 1e3).set("frequency", 501.0).configure(); }) ==
        "frequency is 501 Hz, allowed: at most half of the sample rate, 500 Hz");
  CHECK(refusal_of([&] { duty.set("sample_rate", 1e3).set("frequency", 1.0).set("duty", 1.0).configure(); }) ==
        "duty is 1.000000, allowed: between 0 and 1");
}
