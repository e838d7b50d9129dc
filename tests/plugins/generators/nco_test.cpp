#include <cmath>
#include <numbers>

#include "bodeflow/numerics/fft.hpp"
#include "catch.hpp"
#include "digital_oscillator.hpp"
#include "plugins/loaded_block.hpp"

using namespace bodeflow::generators;
using bodeflow::numerics::Random;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

// The strongest line beside the strongest, in dB below it, of one whole period of the accumulator: no leakage.
double spurious_free_range(const Eigen::VectorXd& x) {
  Eigen::VectorXd amplitudes = bodeflow::numerics::half_dft(x).cwiseAbs();
  Eigen::Index carrier = 0;
  const double strongest = amplitudes.maxCoeff(&carrier);
  amplitudes[carrier] = 0;
  return 20 * std::log10(strongest / amplitudes.maxCoeff());
}

Eigen::VectorXd samples(const OscillatorBits& bits, std::uint64_t word, Eigen::Index count, Random* dither = nullptr) {
  DigitalOscillator oscillator(bits);
  oscillator.tune(word);
  Eigen::VectorXd x(count);
  for (double& value : x) value = dither == nullptr ? oscillator.next() : oscillator.next(*dither);
  return x;
}

constexpr OscillatorBits kBits{16, 8, 24};
constexpr Eigen::Index kPeriod = 1 << 16;

}  // namespace

TEST_CASE("the spurs of phase truncation keep below 6.02 T - 3.92 dB for every kind of tuning word, and reach it") {
  const double bound = 6.0206 * 8 - 3.92;
  double least = 1e9;
  for (int trailing = 0; trailing < 8; ++trailing) {
    for (const std::uint64_t odd : {1u, 5u, 77u}) {
      const std::uint64_t word = odd << trailing;
      const double range = spurious_free_range(samples(kBits, word, kPeriod));
      CAPTURE(word, range);
      CHECK(range > bound - 0.05);
      least = std::min(least, range);
    }
  }
  CHECK(least < bound + 0.05);
}

TEST_CASE("a word without dropped bits has no spurs but those of the words") {
  CHECK(spurious_free_range(samples(kBits, 5 << 8, kPeriod)) > 130);
  CHECK(spurious_free_range(samples({16, 8, 8}, 5 << 8, kPeriod)) > 48);
}

TEST_CASE("phase dithering spreads the spurs into noise") {
  const std::uint64_t word = (5u << 8) + 128;  // the worst kind
  Random random(3);
  const Eigen::VectorXd dithered = samples(kBits, word, kPeriod, &random);
  const double plain = spurious_free_range(samples(kBits, word, kPeriod)), spread = spurious_free_range(dithered);
  CHECK(plain < 44.3);
  CHECK(spread > plain + 25);
  // The sine itself stays.
  double along = 0;
  for (Eigen::Index n = 0; n < kPeriod; ++n) {
    const double cycles = static_cast<double>(static_cast<std::uint64_t>(n) * word % 65536) / 65536;
    along += 2 * dithered[n] * std::sin(2 * std::numbers::pi * cycles) / static_cast<double>(kPeriod);
  }
  CHECK(along == Approx(1).epsilon(1e-3));
}

TEST_CASE("the table has the words of a sine") {
  const Eigen::VectorXd x = samples({4, 4, 3}, 1, 16);
  for (Eigen::Index i = 0; i < 16; ++i)
    CHECK(x[i] == std::nearbyint(3 * std::sin(2 * std::numbers::pi * static_cast<double>(i) / 16)) / 3);
}

TEST_CASE("the frequency of an oscillator is the nearest multiple of rate / 2^B, and a live change keeps the phase") {
  LoadedBlock block("generators.nco");
  block.set("sample_rate", 1000.0)
      .set("frequency", 10.0)
      .set("accumulator_bits", std::int64_t{10})
      .set("table_bits", std::int64_t{10});
  block.set("amplitude", 2.0).set("offset", 1.0).start();
  REQUIRE(block.log().size() == 1);
  CHECK(block.log()[0] == "tuning word 10, frequency 9.765625 Hz");
  const auto y = block.run(100, 7)[0];
  for (int n = 0; n < 100; ++n)
    CHECK(y[static_cast<std::size_t>(n)] == Approx(1 + 2 * std::sin(2 * std::numbers::pi * (10 * n % 1024) / 1024)).margin(1e-4));
  block.change("frequency", 50.0);  // word 51
  const auto z = block.run(50, 7)[0];
  for (int n = 0; n < 50; ++n)
    CHECK(z[static_cast<std::size_t>(n)] == Approx(1 + 2 * std::sin(2 * std::numbers::pi * (1000 + 51 * n) / 1024)).margin(1e-4));
}

TEST_CASE("the widest and the narrowest oscillators work, and dither follows the seed") {
  for (const auto& [b, t, a] : {std::tuple{48, 20, 32}, {2, 1, 2}, {20, 20, 16}}) {
    LoadedBlock block("generators.nco");
    block.set("sample_rate", 1e3)
        .set("frequency", 123.0)
        .set("accumulator_bits", std::int64_t{b})
        .set("table_bits", std::int64_t{t});
    block.set("amplitude_bits", std::int64_t{a}).set("dither", true).start(4096, 5);
    const auto y = block.run(1000, 100);
    block.reset();
    CHECK(block.run(1000, 33) == y);
    for (const double value : y[0]) REQUIRE(std::abs(value) <= 1);
  }
}

TEST_CASE("an oscillator with a table wider than its accumulator is refused") {
  LoadedBlock wide("generators.nco"), fast("generators.nco");
  CHECK(refusal_of([&] {
          wide.set("sample_rate", 1e3).set("frequency", 1.0).set("accumulator_bits", std::int64_t{8}).configure();
        }) == "table_bits is 12, allowed: 1 to 8");
  CHECK(refusal_of([&] { fast.set("sample_rate", 1e3).set("frequency", 501.0).configure(); }) ==
        "frequency is 501 Hz, allowed: at most half of the sample rate, 500 Hz");
}
