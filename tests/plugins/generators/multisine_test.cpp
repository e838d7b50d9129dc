#include "multisine.hpp"

#include <cmath>
#include <numbers>

#include "bodeflow/numerics/fft.hpp"
#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using namespace bodeflow::generators;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

// Amplitude and phase of each line, from the spectrum.
Eigen::VectorXcd lines_of(const std::vector<double>& x) {
  const Eigen::Map<const Eigen::VectorXd> samples(x.data(), static_cast<Eigen::Index>(x.size()));
  return bodeflow::numerics::half_dft(samples) * (2.0 / static_cast<double>(x.size()));
}

LoadedBlock& given(LoadedBlock& block, std::int64_t period, std::int64_t first, std::int64_t last, std::int64_t step) {
  return block.set("sample_rate", 250.0)
      .set("period", period)
      .set("lines.first", first)
      .set("lines.last", last)
      .set("lines.step", step);
}

}  // namespace

TEST_CASE("a synthesised period has its lines exactly and nothing between them, for any length") {
  const std::int64_t period = GENERATE(as<std::int64_t>{}, 5, 64, 97, 128, 360, 1000, 2310, 5120);
  std::vector<Line> lines;
  for (std::int64_t k = 1; k <= (period - 1) / 2; k += 3)
    lines.push_back({k, 1 + 0.1 * static_cast<double>(k % 7), 0.3 * static_cast<double>(k)});
  Eigen::VectorXcd found = lines_of(synthesise(period, lines));
  for (const Line& line : lines) {
    CHECK(std::abs(found[line.k] - std::polar(line.amplitude, line.phase_rad)) < 1e-14 * std::sqrt(static_cast<double>(period)));
    found[line.k] = 0;
  }
  CHECK(found.cwiseAbs().maxCoeff() < 1e-14 * std::sqrt(static_cast<double>(period)));
}

TEST_CASE("a synthesised period equals the sum of its cosines") {
  const std::vector<Line> lines = {{1, 2.0, 0.1}, {5, 0.5, -2.0}, {11, 1.5, 3.0}};
  const std::vector<double> x = synthesise(30, lines);
  for (std::int64_t n = 0; n < 30; ++n) {
    double sum = 0;
    for (const Line& line : lines) {
      sum += line.amplitude * std::cos(2 * std::numbers::pi * static_cast<double>(line.k * n % 30) / 30 + line.phase_rad);
    }
    CHECK(std::abs(x[static_cast<std::size_t>(n)] - sum) < 4e-15);
  }
}

TEST_CASE("Schroeder's phases of a flat spectrum are -i (i - 1) pi / M, whatever the distance of the lines") {
  const std::int64_t step = GENERATE(as<std::int64_t>{}, 1, 2, 5);
  std::vector<Line> lines;
  for (std::int64_t i = 0; i < 7; ++i) lines.push_back({3 + i * step, 0.5, 0.0});
  const std::vector<double> phases = schroeder_phases(lines);
  for (int i = 1; i <= 7; ++i) {
    const double difference = phases[static_cast<std::size_t>(i - 1)] + i * (i - 1) * std::numbers::pi / 7;
    CHECK(std::abs(std::remainder(difference, 2 * std::numbers::pi)) < 1e-14);
  }
}

TEST_CASE("Schroeder phases keep the crest factor of flat multisines below 2, where zero phases reach sqrt(2 M)") {
  for (const std::size_t count : {8u, 24u, 100u, 500u}) {
    std::vector<Line> flat;
    for (std::size_t i = 0; i < count; ++i) flat.push_back({static_cast<std::int64_t>(i + 1), 1.0, 0.0});
    const std::vector<double> phases = schroeder_phases(flat);
    for (std::size_t i = 0; i < count; ++i) flat[i].phase_rad = phases[i];
    const auto period = static_cast<std::int64_t>(16 * count);
    CHECK(crest_factor(synthesise(period, flat)) < 2.0);
    CHECK(crest_factor(synthesise(period, flat)) > std::sqrt(2.0));
    for (Line& line : flat) line.phase_rad = 0;
    CHECK(crest_factor(synthesise(period, flat)) == Approx(std::sqrt(2.0 * static_cast<double>(count))));
  }
}

TEST_CASE("Schroeder's phases follow the power: a shaped spectrum stays a sweep") {
  std::vector<Line> lines;
  for (std::int64_t k = 1; k <= 399; k += 2) lines.push_back({k, 1 / (1 + static_cast<double>(k * k) / 1e4), 0.0});
  const auto with = [&lines](const std::vector<double>& phases) {
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i].phase_rad = phases[i];
    return crest_factor(synthesise(4096, lines));
  };
  const double found = with(schroeder_phases(lines));
  std::vector<Line> flat = lines;
  for (Line& line : flat) line.amplitude = 1;
  const double as_if_flat = with(schroeder_phases(flat));
  CAPTURE(found, as_if_flat);
  CHECK(found < 2.1);
  CHECK(as_if_flat > 2.8);
}

TEST_CASE("the multisine of the design page has its 24 odd lines of 4 V and repeats bit for bit") {
  LoadedBlock block("generators.multisine");
  given(block, 128, 3, 49, 2).set("amplitude", std::vector<double>{4.0}).set("unit", "V").start();
  CHECK(block.resolve()[0].unit == "V");
  CHECK(block.resolve()[0].length == -1);
  const auto y = block.run(1280, 100)[0];
  for (std::size_t n = 128; n < y.size(); ++n) REQUIRE(y[n] == y[n - 128]);
  const Eigen::VectorXcd found = lines_of({y.begin(), y.begin() + 128});
  for (Eigen::Index k = 0; k < found.size(); ++k) {
    const double expected = k >= 3 && k <= 49 && k % 2 == 1 ? 4.0 : 0.0;
    CHECK(std::abs(std::abs(found[k]) - expected) < 1e-13);
  }
  REQUIRE(block.log().size() == 1);
  CHECK(block.log()[0] == "24 lines from 5.859375 Hz to 95.703125 Hz, crest factor 1.77");
}

TEST_CASE("a list of lines takes an amplitude a line") {
  LoadedBlock block("generators.multisine");
  block.set("sample_rate", 1e3).set("period", std::int64_t{100}).set("lines.list", std::vector<std::int64_t>{1, 7, 30});
  block.set("amplitude", std::vector<double>{1.0, 2.0, 0.5}).set("phases", "zero").start();
  const Eigen::VectorXcd found = lines_of(block.run(100)[0]);
  CHECK(std::abs(found[1] - 1.0) < 1e-14);
  CHECK(std::abs(found[7] - 2.0) < 1e-14);
  CHECK(std::abs(found[30] - 0.5) < 1e-14);
}

TEST_CASE("random phases follow the seed") {
  const auto period = [](std::uint64_t seed) {
    LoadedBlock block("generators.multisine");
    given(block, 256, 1, 100, 1).set("phases", "random").start(4096, seed);
    return block.run(256)[0];
  };
  CHECK(period(1) == period(1));
  CHECK(period(1) != period(2));
  const Eigen::VectorXcd found = lines_of(period(3));
  double mean_direction = 0;
  for (Eigen::Index k = 1; k <= 100; ++k) {
    CHECK(std::abs(std::abs(found[k]) - 1) < 1e-13);
    mean_direction += std::cos(std::arg(found[k])) / 100;
  }
  CHECK(std::abs(mean_direction) < 4 * std::sqrt(0.5 / 100));
}

TEST_CASE("a multisine with a number of periods ends after them") {
  LoadedBlock block("generators.multisine");
  given(block, 64, 1, 9, 1).set("periods", std::int64_t{3}).start();
  CHECK(block.resolve()[0].length == 192);
  CHECK(block.run(1000, 100)[0].size() == 192);
}

TEST_CASE("lines that a period cannot hold are refused") {
  const auto refused = [](auto&& set) {
    LoadedBlock block("generators.multisine");
    block.set("sample_rate", 250.0).set("period", std::int64_t{128});
    set(block);
    return refusal_of([&] { block.configure(); });
  };
  using List = std::vector<std::int64_t>;
  CHECK(refused([](LoadedBlock&) {}) == "lines needs first and last, or a list");
  CHECK(refused([](LoadedBlock& b) { given(b, 128, 3, 64, 1); }) ==
        "line 64 does not lie between zero and half of the period of 128 samples; allowed: 1 to 63");
  CHECK(refused([](LoadedBlock& b) { given(b, 128, 9, 3, 1); }) == "lines.last 3 is below lines.first 9");
  CHECK(refused([](LoadedBlock& b) { b.set("lines.list", List{3, 3}); }) == "lines.list is not ascending");
  CHECK(refused([](LoadedBlock& b) { b.set("lines.list", List{}); }) == "lines.list is empty");
  CHECK(refused([](LoadedBlock& b) { given(b, 128, 3, 9, 1).set("lines.list", List{3}); }) ==
        "lines has a list as well as first, last or step; allowed: one of the two");
  CHECK(refused([](LoadedBlock& b) {
          given(b, 128, 3, 9, 2).set("amplitude", std::vector<double>{1, 2});
        }) == "amplitude has 2 values, allowed: 1, or one for each of the 4 lines");
}
