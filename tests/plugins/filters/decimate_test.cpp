#include <cmath>
#include <numbers>

#include "bodeflow/numerics/fir.hpp"
#include "catch.hpp"
#include "decimator.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Rate;
using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::Stream;

namespace {

// f in fractions of the input's Nyquist frequency.
std::vector<double> tone(double f, std::size_t count) {
  std::vector<double> x(count);
  for (std::size_t n = 0; n < count; ++n) x[n] = std::cos(std::numbers::pi * std::fmod(f * static_cast<double>(n), 2.0));
  return x;
}

LoadedBlock& given(LoadedBlock& block, std::int64_t factor, Stream input) {
  return block.set("factor", factor).feed({std::move(input)}).start();
}

constexpr std::size_t kSettled = 60;  // outputs: more than 2 K = 52

}  // namespace

TEST_CASE("anti-alias filters pass to 0.8 and stop from the new Nyquist frequency on by 80 dB, for small and large factors") {
  for (const std::size_t factor : {2u, 3u, 10u, 40u}) {
    const std::vector<double> h = *bodeflow::filters::anti_alias_taps(factor, 0.8, 80);
    CHECK((h.size() - 1) % (2 * factor) == 0);
    CHECK((h.size() - 1) / (2 * factor) == 26);
    const Eigen::Map<const Eigen::VectorXd> taps(h.data(), static_cast<Eigen::Index>(h.size()));
    const double nyquist = 1.0 / static_cast<double>(factor);
    double pass = 0;
    double stop = 0;
    for (int k = 0; k <= 400; ++k) {
      pass = std::max(pass, std::abs(std::abs(bodeflow::numerics::fir_response(taps, 0.8 * nyquist * k / 400)) - 1));
      stop = std::max(stop, std::abs(bodeflow::numerics::fir_response(taps, nyquist + (1 - nyquist) * k / 400)));
    }
    CHECK(pass < 2e-4);
    CHECK(stop < 1e-4);
  }
}

TEST_CASE("decimate passes a tone of the pass band, delayed by 26 output samples, and removes one that would fold down") {
  const std::int64_t factor = 10;
  LoadedBlock pass("filters.decimate"), stop("filters.decimate");
  const auto y = given(pass, factor, Stream::of(tone(0.07, 2000), {10000, 1})).run(200)[0];
  CHECK(pass.resolve()[0].rate == Rate(1000, 1));
  for (std::size_t m = kSettled; m < 200; ++m) {
    const double expected = std::cos(std::numbers::pi * 0.07 * 10 * (static_cast<double>(m) - 26));
    CHECK(std::abs(y[m] - expected) < 2e-4);
  }
  const auto gone = given(stop, factor, Stream::of(tone(0.13, 2000))).run(200)[0];
  for (std::size_t m = kSettled; m < 200; ++m) CHECK(std::abs(gone[m]) < 1e-4);
}

TEST_CASE("decimate passes a constant as it is") {
  LoadedBlock block("filters.decimate");
  const auto y = given(block, 4, Stream::of(std::vector<double>(800, 3.0))).run(200)[0];
  CHECK(y[199] == Approx(3.0).epsilon(1e-15));
}

TEST_CASE("decimate without a filter keeps every factor-th sample") {
  std::vector<double> x(12);
  for (std::size_t n = 0; n < 12; ++n) x[n] = static_cast<double>(n);
  Stream input = Stream::of(x);
  input.facts.length = 12;
  LoadedBlock block("filters.decimate");
  given(block.set("anti_alias", false), 4, input);
  CHECK(block.resolve()[0].length == 3);
  CHECK(block.input_flows()[0].samples == 4);
  CHECK(block.run(3, 2) == Channels{{0, 4, 8}});
}

TEST_CASE("the chunks of a decimation do not show in its bits, reset clears its past") {
  const Stream input = Stream::with({tone(0.031, 3000), tone(0.2, 3000)});
  LoadedBlock whole("filters.decimate"), cut("filters.decimate");
  const auto y = given(whole, 3, input).run(1000, 1000);
  CHECK(given(cut, 3, input).run(1000, 7) == y);
  cut.reset();
  CHECK(cut.run(1000, 1) == y);
}

TEST_CASE("an anti-alias filter without room for its transition is refused") {
  CHECK(bodeflow::filters::anti_alias_taps(2, 1.0, 80).error().text == "the edges of the bands must be 0 < pass < stop <= 1");
  CHECK(bodeflow::filters::anti_alias_taps(2, 0.8, 1000).error().text == "the attenuation must be 21 to 200 dB");
}
