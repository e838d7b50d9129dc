#include <bodeflow/numerics/fir_design.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "interpolator.hpp"
#include "moving_average.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Matrix;
using bodeflow::Rate;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;
using bodeflow::test::Stream;
namespace numerics = bodeflow::numerics;

namespace {

using List = std::vector<double>;

List impulse(std::size_t count) {
  List x(count);
  x[0] = 1;
  return x;
}

List noise(std::size_t count) {
  numerics::Random random(3);
  List x(count);
  for (double& value : x) value = random.normal();
  return x;
}

List run(LoadedBlock& block, List x) {
  const std::size_t count = x.size();
  return block.feed({Stream::of(std::move(x))}).start().run(count)[0];
}

List padded(const Eigen::VectorXd& taps, std::size_t count) {
  List list(taps.begin(), taps.end());
  list.resize(count);
  return list;
}

template <class Set>
std::string refusal(const std::string& id, Set&& set) {
  LoadedBlock block(id);
  set(block);
  block.feed({Stream::of(List(8))});
  return refusal_of([&] { block.start(); });
}

}  // namespace

TEST_CASE("filters.fir has the impulse response of its design, edges and bands in Hz") {
  LoadedBlock window("filters.fir"), squares("filters.fir"), given("filters.fir");
  window.set("taps", std::int64_t{31}).set("edges", List{100, 200}).set("pass", "band_pass").set("window", "blackman");
  CHECK(run(window, impulse(40)) ==
        padded(*numerics::fir_by_window({numerics::Pass::band, 31, {0.2, 0.4}, numerics::Window::blackman}), 40));
  squares.set("method", "least_squares").set("taps", std::int64_t{24}).set("weights", List{1, 9});
  squares.set("bands", Matrix{2, 2, {0, 100, 150, 500}}).set("gains", Matrix{2, 2, {1, 1, 0, 0}});
  CHECK(run(squares, impulse(40)) == padded(*numerics::fir_by_least_squares(24, {{0, 0.2, 1, 1, 1}, {0.3, 1, 0, 0, 9}}), 40));
  CHECK(run(given.set("method", "given").set("coefficients", List{1, -2, 0.5}), impulse(5)) == List{1, -2, 0.5, 0, 0});
}

TEST_CASE("a moving average is the mean of the last samples, exactly for whole numbers, whatever the chunks") {
  LoadedBlock block("filters.moving_average"), cut("filters.moving_average");
  List x(100);
  for (std::size_t n = 0; n < 100; ++n) x[n] = static_cast<double>((n * 37) % 64);
  const List y = run(block.set("length", std::int64_t{8}), x);
  for (std::size_t n = 0; n < 100; ++n) {
    double sum = 0;
    for (std::size_t j = 0; j < 8 && j <= n; ++j) sum += x[n - j];
    CHECK(y[n] == sum / 8);
  }
  cut.set("length", std::int64_t{8}).feed({Stream::of(x)}).start();
  CHECK(cut.run(100, 3)[0] == y);
  cut.reset();
  CHECK(cut.run(100, 1)[0] == y);
}

TEST_CASE("a moving average neither drifts nor remembers what was large or not finite") {
  bodeflow::filters::MovingAverage average(100);
  List x = noise(20000);
  x[5] = 1e18;
  x[300] = std::nan("");
  List y(x.size());
  average.run(x, y);
  CHECK(std::isnan(y[399]));
  double worst = 0;
  for (std::size_t n = 500; n < x.size(); ++n) {
    long double sum = 0;
    for (std::size_t j = 0; j < 100; ++j) sum += x[n - j];
    worst = std::max(worst, std::abs(y[n] - static_cast<double>(sum / 100)));
  }
  CHECK(worst < 1e-15);
}

TEST_CASE("interpolation gives back the samples of a tone in between, delayed by 26 samples") {
  List x(400);
  const double f = 0.3 * std::numbers::pi;
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::cos(f * static_cast<double>(n));
  LoadedBlock block("filters.interpolate");
  block.set("factor", std::int64_t{5}).feed({Stream::of(x)}).start();
  CHECK(block.resolve()[0].rate == Rate(5000, 1));
  const List y = block.run(400)[0];
  REQUIRE(y.size() == 2000);
  for (std::size_t n = 60 * 5; n < y.size(); ++n) CHECK(std::abs(y[n] - std::cos(f * (static_cast<double>(n) / 5 - 26))) < 3e-4);
}

TEST_CASE("an interpolator is the convolution with zeros between the samples, whatever the chunks") {
  const List h = noise(17), x = noise(50);
  List whole(150), cut(150);
  bodeflow::filters::Interpolator one(h, 3, 50), other(h, 3, 7);
  one.run(x, whole);
  for (std::size_t n = 0; n < 50; n += 7) {
    const std::size_t part = std::min<std::size_t>(7, 50 - n);
    other.run(std::span(x).subspan(n, part), std::span(cut).subspan(3 * n, 3 * part));
  }
  CHECK(cut == whole);
  for (std::size_t n = 0; n < 150; ++n) {
    double sum = 0;
    for (std::size_t j = 0; j < h.size() && j <= n; ++j) sum += (n - j) % 3 == 0 ? h[j] * x[(n - j) / 3] : 0.0;
    CHECK(whole[n] == Approx(sum).margin(1e-13));
  }
}

TEST_CASE("finite impulse responses that cannot be are refused by name") {
  CHECK(refusal("filters.fir", [](LoadedBlock& b) {
          b.set("edges", List{100, 200});
        }) == "edges has 2 values; allowed: 1, the edges of a low_pass filter");
  CHECK(refusal("filters.fir", [](LoadedBlock& b) { b.set("edges", List{500}); }) ==
        "edges: 500 Hz; allowed: above 0 and below the Nyquist frequency 500 Hz of 'in'");
  CHECK(refusal("filters.fir", [](LoadedBlock& b) {
          b.set("edges", List{100}).set("pass", "high_pass").set("taps", std::int64_t{20});
        }) == "filter: 20 taps: a symmetric filter with an even number of them is 0 at the Nyquist frequency; allowed here: odd");
  CHECK(refusal("filters.fir", [](LoadedBlock& b) { b.set("method", "given"); }) ==
        "coefficients has 0 values; allowed: 1 to 65536 finite ones");
  CHECK(refusal("filters.fir", [](LoadedBlock& b) { b.set("method", "least_squares"); }) ==
        "method least_squares needs bands and gains");
}
