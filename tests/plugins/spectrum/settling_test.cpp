#include "spectrum/settling.hpp"

#include <algorithm>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "catch.hpp"
#include "spectrum/sine_window.hpp"

using namespace bodeflow::spectrum;
using bodeflow::numerics::Random;
using std::numbers::pi;

namespace {

constexpr double kReference = 1e-12;  // two programs that add 32 products in another order

std::vector<double> noise(std::size_t count, std::uint64_t seed, double sigma = 1.0) {
  Random random(seed);
  std::vector<double> e(count);
  for (double& x : e) x = sigma * random.normal();
  return e;
}

double rms(const std::vector<double>& v) {
  double power = 0.0;
  for (const double x : v) power += x * x;
  return std::sqrt(power / static_cast<double>(v.size()));
}

}  // namespace

TEST_CASE("settling: coefficients, settling time and estimates agree with the reference") {
  const auto reference = nlohmann::json::parse(std::ifstream(BODEFLOW_TEST_DATA "/stepped_sine_small.json"));
  const auto y = reference["y"].get<std::vector<double>>();
  const auto a = reference["A_t"].get<std::vector<double>>(), b = reference["B_t"].get<std::vector<double>>();
  const Correlation c = sliding_correlation(y, reference["Npp"].get<std::int64_t>(), 1);
  REQUIRE(c.a.size() == a.size());
  REQUIRE(c.b.size() == b.size());
  for (std::size_t p = 0; p < a.size(); ++p) {
    CHECK(std::abs(c.a[p] - a[p]) < kReference);
    CHECK(std::abs(c.b[p] - b[p]) < kReference);
  }
  const std::size_t from = settled_from(c, reference["threshold"].get<double>());
  CHECK(from == reference["i1"].get<std::size_t>());
  CHECK(std::abs(mean_from(c.a, from) - reference["A"].get<double>()) < kReference);
  CHECK(std::abs(mean_from(c.b, from) - reference["B"].get<double>()) < kReference);
}

TEST_CASE("settling: a sine's coefficients stand apart from an offset and from harmonics, in windows of several cycles as well") {
  constexpr int kWindow = 45, kCycles = 4;
  std::vector<double> y;
  for (int n = 0; n < 200; ++n) {
    const double theta = 2 * pi * kCycles * n / kWindow;
    y.push_back(1e3 + 0.7 * std::cos(theta) - 0.4 * std::sin(theta) + 3 * std::cos(2 * theta + 1) - 2 * std::sin(5 * theta));
  }
  const Correlation c = sliding_correlation(y, kWindow, kCycles);
  REQUIRE(c.a.size() == 200 - kWindow + 1);
  for (std::size_t p = 0; p < c.a.size(); ++p) {
    CHECK(std::abs(c.a[p] - 0.7) < 1e-12);
    CHECK(std::abs(c.b[p] + 0.4) < 1e-12);
  }
  CHECK(sliding_correlation(std::span(y).first(kWindow - 1), kWindow, kCycles).a.empty());
  CHECK(settled_from({}, 1.0) == 0);
}

TEST_CASE("settling: the envelope is the range of what is still to come") {
  CHECK(envelope(std::vector<double>{5, 1, 4, 2, 3, 3}) == std::vector<double>{4, 3, 2, 1, 0, 0});
  CHECK(envelope({}).empty());
}

TEST_CASE("settling: the running test agrees with the envelope of all values so far, after each value") {
  for (const double range : {0.0, 0.5, 1.5, 4.0, 100.0}) {
    std::vector<double> a;
    SettledStretch stretch(range);
    for (const double e : noise(300, 5)) {
      a.push_back(e + 3 * std::exp(-0.02 * static_cast<double>(a.size())));
      stretch.push(a.back());
      const auto delta = envelope(a);
      const auto first = std::find_if(delta.begin(), delta.end(), [&](double d) { return d <= range; });
      REQUIRE(stretch.from() == static_cast<std::size_t>(first - delta.begin()));
    }
  }
}

TEST_CASE("settling: the later of the two coefficients counts") {
  Correlation c{{0, 0, 9, 1, 1, 1}, {1, 1, 1, 1, 5, 5}};
  CHECK(settled_from(c, 0.5) == 4);
  std::swap(c.a, c.b);
  CHECK(settled_from(c, 0.5) == 4);
}

TEST_CASE("settling: noise gives a coefficient the standard deviation sigma sqrt(2 / N), the printed threshold is far above it") {
  constexpr std::int64_t kWindow = 64;
  const auto c = sliding_correlation(noise(64 * 4000, 11, 0.1), kWindow, 3);
  const double expected = 0.1 * std::sqrt(2.0 / kWindow);
  CHECK(rms(c.a) == Approx(expected).epsilon(0.05));
  CHECK(rms(c.b) == Approx(expected).epsilon(0.05));
  CHECK(settling_threshold(0.1, kWindow) == Approx(9.6 * expected).epsilon(1e-12));
  CHECK(6 * 0.1 / expected == Approx(33.9).epsilon(1e-2));
}

TEST_CASE("settling: noise alone does not hold the corrected test up in 300 windows, but does at 6 standard deviations") {
  constexpr std::int64_t kWindow = 64;
  int corrected = 0, narrow = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto c = sliding_correlation(noise(kWindow * 300, seed), kWindow, 1);
    corrected += settled_from(c, settling_threshold(1.0, kWindow)) == 0;
    narrow += settled_from(c, settling_threshold(1.0, kWindow, 6.0)) == 0;
  }
  CHECK(corrected == 40);
  CHECK(narrow < 20);
}

TEST_CASE("sliding sums: what came before the newest two windows leaves no trace, to the bit") {
  const auto quiet = noise(150, 3);
  SineWindow fresh(50), long_used(50);
  for (const double x : noise(50'000, 4, 1e12)) long_used.push({x, 1e3 * x});
  for (std::size_t n = 0; n < quiet.size(); ++n) {
    const std::complex<double> term(quiet[n], -quiet[n]);
    const auto a = fresh.push(term), b = long_used.push(term);
    if (n >= 99) REQUIRE(a == b);
  }
  long_used.clear();
  CHECK(long_used.push(1.5) == 1.5);
}

TEST_CASE("sliding sums: the error does not grow with the length of the stream") {
  constexpr std::size_t kWindow = 1000;
  const SineTable table(kWindow, 7);
  SineWindow sum(kWindow);
  double largest = 0.0;
  for (std::size_t n = 0; n < 3'000'000; ++n) {
    // An offset of a million and a sine of amplitude 1.
    const auto x = sum.push((1e6 + std::real(table[n % kWindow]) * kWindow / 2) * table[n % kWindow]);
    if (n >= 2'900'000) largest = std::max(largest, std::abs(x - 1.0));
  }
  CHECK(largest < 1e-10);  // 1e6 times 1e-16 a few times
}

TEST_CASE("sine table: values are right to rounding, however many cycles the window holds") {
  for (const std::int64_t cycles : {1, 4, 333, 499}) {
    const SineTable table(1000, cycles);
    for (std::int64_t n = 0; n < 1000; ++n) {
      const auto turned = static_cast<long double>(n * cycles % 1000) / 1000.0L;
      const auto value = table[static_cast<std::size_t>(n)] * 500.0;
      CHECK(std::abs(value.real() - static_cast<double>(std::cos(2 * std::numbers::pi_v<long double> * turned))) < 6e-16);
      CHECK(std::abs(value.imag() + static_cast<double>(std::sin(2 * std::numbers::pi_v<long double> * turned))) < 6e-16);
    }
  }
}
