#include <cmath>

#include "bodeflow/numerics/fft.hpp"
#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;

namespace {

constexpr std::size_t kSamples = 1 << 16;
const double kRoot = std::sqrt(static_cast<double>(kSamples));

Channels noise(std::int64_t seed, const char* distribution, std::int64_t channels = 1, std::uint64_t chunk = 1000) {
  LoadedBlock block("generators.noise");
  block.set("sample_rate", 1e4)
      .set("seed", seed)
      .set("distribution", distribution)
      .set("std", 2.0)
      .set("mean", 5.0)
      .set("channels", channels);
  return block.start().run(kSamples, chunk);
}

double mean(const std::vector<double>& x, int power, double centre) {
  double sum = 0;
  for (const double value : x) sum += std::pow(value - centre, power);
  return sum / static_cast<double>(x.size());
}

}  // namespace

TEST_CASE("normal noise has the moments asked for") {
  const auto x = noise(11, "normal")[0];
  // Four standard deviations of each estimate.
  CHECK(std::abs(mean(x, 1, 5)) < 4 * 2 / kRoot);
  CHECK(std::abs(mean(x, 2, 5) / 4 - 1) < 4 * std::sqrt(2.0) / kRoot);
  CHECK(std::abs(mean(x, 3, 5) / 8) < 4 * std::sqrt(15.0) / kRoot);
  CHECK(std::abs(mean(x, 4, 5) / 16 - 3) < 4 * std::sqrt(96.0) / kRoot);
}

TEST_CASE("uniform noise has the moments asked for and its limits") {
  const auto x = noise(12, "uniform")[0];
  CHECK(std::abs(mean(x, 1, 5)) < 4 * 2 / kRoot);
  // Kurtosis 1.8: the variance of the squares is 0.8.
  CHECK(std::abs(mean(x, 2, 5) / 4 - 1) < 4 * std::sqrt(0.8) / kRoot);
  const double width = 2 * std::sqrt(3.0);
  for (const double value : x) REQUIRE(std::abs(value - 5) < width);
  CHECK(*std::max_element(x.begin(), x.end()) > 5 + 0.999 * width);
}

TEST_CASE("noise is white: no band of its spectrum has more power than another") {
  const auto x = noise(13, "normal")[0];
  Eigen::VectorXd centred(kSamples);
  for (std::size_t n = 0; n < kSamples; ++n) centred[static_cast<Eigen::Index>(n)] = (x[n] - 5) / 2;
  const Eigen::VectorXd power = bodeflow::numerics::half_dft(centred).cwiseAbs2() / static_cast<double>(kSamples);
  // 64 bands of 512 lines; each line's power is exponential with mean 1, a band's mean has a standard deviation of 1/sqrt(512).
  for (Eigen::Index band = 0; band < 64; ++band)
    CHECK(std::abs(power.segment(1 + band * 511, 511).mean() - 1) < 4.5 / std::sqrt(511.0));
}

TEST_CASE("the bits of noise depend on the seed and not on the chunks") {
  CHECK(noise(14, "normal", 2, 1) == noise(14, "normal", 2, 4096));
  CHECK(noise(14, "normal") != noise(15, "normal"));
}

TEST_CASE("channels of noise are independent, and adding a channel leaves the others as they were") {
  const Channels two = noise(16, "normal", 2);
  const Channels three = noise(16, "normal", 3);
  CHECK(three[0] == two[0]);
  CHECK(three[1] == two[1]);
  double correlation = 0;
  for (std::size_t n = 0; n < kSamples; ++n) correlation += (two[0][n] - 5) * (two[1][n] - 5) / 4 / static_cast<double>(kSamples);
  CHECK(std::abs(correlation) < 4 / kRoot);
}

TEST_CASE("without a seed of its own noise takes the block's seed of the run") {
  const auto run = [](std::uint64_t seed) {
    LoadedBlock block("generators.noise");
    return block.set("sample_rate", 1e3).start(4096, seed).run(10);
  };
  CHECK(run(1) == run(1));
  CHECK(run(1) != run(2));
}

TEST_CASE("reset repeats the noise, and a live standard deviation scales it") {
  LoadedBlock block("generators.noise");
  block.set("sample_rate", 1e3).start();
  const auto first = block.run(100);
  block.reset();
  CHECK(block.run(100) == first);
  block.reset();
  block.change("std", 3.0);
  const auto scaled = block.run(100);
  for (std::size_t n = 0; n < 100; ++n) CHECK(scaled[0][n] == 3 * first[0][n]);
}
