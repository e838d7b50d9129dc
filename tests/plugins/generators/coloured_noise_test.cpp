#include <cmath>
#include <complex>
#include <numbers>

#include "bodeflow/numerics/fft.hpp"
#include "catch.hpp"
#include "plugins/loaded_block.hpp"
#include "shaping_filter.hpp"

using namespace bodeflow::generators;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;

namespace {

using List = std::vector<double>;
constexpr Eigen::Index kWindow = 1024, kWindows = 400;

// One-sided power density over frequency from Hann windows (leakage falls fast), each of `kWindows` windows' mean.
Eigen::VectorXd density(const List& x, double rate) {
  Eigen::VectorXd window(kWindow), sum = Eigen::VectorXd::Zero(kWindow / 2 + 1);
  for (Eigen::Index n = 0; n < kWindow; ++n) window[n] = 1 - std::cos(2 * std::numbers::pi * static_cast<double>(n) / kWindow);
  for (Eigen::Index w = 0; w < kWindows; ++w) {
    const Eigen::Map<const Eigen::VectorXd> part(x.data() + w * kWindow, kWindow);
    sum += bodeflow::numerics::half_dft(part.cwiseProduct(window)).cwiseAbs2();
  }
  return sum * (2 / (rate * window.squaredNorm() * static_cast<double>(kWindows)));
}

double mean_square(const List& x, double mean) {
  double sum = 0;
  for (const double value : x) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(x.size());
}

}  // namespace

TEST_CASE("the spectrum of filtered noise is |H|^2 with the density asked for") {
  LoadedBlock block("generators.coloured_noise");
  block.set("sample_rate", 2e3).set("numerator", List{1, 0.5}).set("denominator", List{1, -1.2, 0.6});
  block.set("density", 0.02).set("density_at", 100.0).set("seed", std::int64_t{3}).start();
  const List x = block.run(kWindow * kWindows, 1000)[0];
  const Eigen::VectorXd found = density(x, 2e3);
  const auto power = [](double f) {
    const std::complex<double> z = std::polar(1.0, 2 * std::numbers::pi * f / 2e3);
    return std::norm((z + 0.5) / (z * z - 1.2 * z + 0.6));
  };
  // A mean over 16 lines and 400 windows, neighbouring Hann lines correlated: a standard deviation of about 1.7 %.
  for (Eigen::Index first = 8; first + 16 < 512; first += 16) {
    double expected = 0;
    for (Eigen::Index k = first; k < first + 16; ++k)
      expected += 4e-4 * power(static_cast<double>(k) * 2e3 / kWindow) / power(100) / 16;
    CHECK(found.segment(first, 16).mean() == Approx(expected).epsilon(0.07));
  }
}

TEST_CASE("filtered noise is stationary from its first sample and has the std asked for") {
  // Poles at 0.999: a transient of some thousand samples, were there one.
  LoadedBlock block("generators.coloured_noise");
  block.set("sample_rate", 1e3).set("denominator", List{1, -1.99, 0.9901}).set("std", 2.0).set("mean", 7.0);
  block.set("channels", std::int64_t{2000}).start();
  const auto y = block.run(2, 1);
  List first, second;
  double products = 0;
  for (const auto& channel : y) {
    first.push_back(channel[0]);
    second.push_back(channel[1]);
    products += (channel[0] - 7) * (channel[1] - 7) / 2000;
  }
  // Four standard deviations of a variance from 2000 values.
  const double tolerance = 4 * std::sqrt(2.0 / 2000);
  CHECK(mean_square(first, 7) == Approx(4).epsilon(tolerance));
  CHECK(mean_square(second, 7) == Approx(4).epsilon(tolerance));
  // r(1)/r(0) = -a1 / (1 + a2) of an autoregression of order two.
  CHECK(products / 4 == Approx(1.99 / 1.9901).epsilon(tolerance));
}

TEST_CASE("the variance of an autoregression is its closed form, and the root of a covariance gives it back") {
  Eigen::VectorXd one(1), ar(2);
  one << 1;
  ar << 1, -0.9;
  const auto filter = *rational_filter(one, ar);
  const Eigen::MatrixXd covariance = stationary_covariance(filter);
  CHECK(output_std(filter, covariance) == Approx(std::sqrt(1 / (1 - 0.81))).epsilon(1e-14));

  Eigen::VectorXd below(5);
  below << 1, -1.5, 0.8, 0.1, -0.05;
  const auto high = *rational_filter(one, below);
  const Eigen::MatrixXd p = stationary_covariance(high);
  const Eigen::MatrixXd residue = high.A * p * high.A.transpose() + high.B * high.B.transpose() - p;
  CHECK(residue.cwiseAbs().maxCoeff() < 1e-12 * p.cwiseAbs().maxCoeff());
  const Eigen::MatrixXd root = covariance_root(p);
  CHECK((root * root.transpose() - p).cwiseAbs().maxCoeff() < 1e-12 * p.cwiseAbs().maxCoeff());
}

TEST_CASE("power laws keep within 0.6 dB from three times the lowest frequency to a fifth of the rate") {
  for (const double exponent : {0.5, 1.0, 1.5, 2.0}) {
    const double lowest = 1e-5;
    const auto filter = power_law_filter(exponent, lowest);
    const auto level = [&](double f) { return 20 * std::log10(gain_at(filter, f)) + 10 * exponent * std::log10(f); };
    double least = 1e9, most = -1e9;
    for (double f = 3 * lowest; f < 0.2; f *= 1.05) {
      least = std::min(least, level(f));
      most = std::max(most, level(f));
    }
    CAPTURE(exponent, least, most, level(0.49) - most);
    CHECK(most - least < 1.2);
    CHECK(std::abs(level(0.49) - 0.5 * (least + most)) < 4.0);
  }
}

TEST_CASE("1/f noise has its density at the frequency asked for, and the same in each decade") {
  LoadedBlock block("generators.coloured_noise");
  block.set("sample_rate", 1e3).set("exponent", 1.0).set("lowest", 0.1).set("density", 0.3).set("density_at", 10.0).start();
  const Eigen::VectorXd found = density(block.run(kWindow * kWindows, 4096)[0], 1e3);
  for (Eigen::Index first = 8; first < 200; first *= 2) {
    double expected = 0;
    for (Eigen::Index k = first; k < 2 * first; ++k) expected += 0.09 * 10 / (static_cast<double>(k) * 1e3 / kWindow);
    CHECK(found.segment(first, first).sum() == Approx(expected).epsilon(0.2));
  }
}

TEST_CASE("coloured noise follows its seed, not its chunks, and reset repeats it") {
  LoadedBlock a("generators.coloured_noise"), b("generators.coloured_noise");
  for (auto* block : {&a, &b})
    block->set("sample_rate", 1e3).set("exponent", 1.0).set("lowest", 1.0).set("channels", std::int64_t{2}).start();
  const auto whole = a.run(1000, 1000);
  CHECK(b.run(1000, 7) == whole);
  a.reset();
  CHECK(a.run(1000, 100) == whole);
  CHECK(whole[0] != whole[1]);
}

TEST_CASE("noise filters that grow, or that are named in part, are refused") {
  const auto refused = [](auto&& set) {
    LoadedBlock block("generators.coloured_noise");
    block.set("sample_rate", 1e3);
    set(block);
    return refusal_of([&] { block.configure(); });
  };
  CHECK(refused([](auto&) {}) == "one of numerator and denominator, or exponent, must be given");
  CHECK(refused([](auto& b) { b.set("exponent", 1.0); }) == "exponent and lowest belong together");
  CHECK(refused([](auto& b) {
          b.set("denominator", List{1, -1});
        }) == "the noise filter has a pole of magnitude 1.000000; allowed: below 1, else the noise grows without end");
  CHECK(refused([](auto& b) { b.set("exponent", 3.0).set("lowest", 1.0); }) ==
        "exponent is 3.000000, allowed: above 0, at most 2");
  CHECK(refused([](auto& b) { b.set("exponent", 1.0).set("lowest", 500.0); }) ==
        "lowest is 500 Hz, allowed: 1e-06 Hz to half of the sample rate, 500 Hz");
  CHECK(refused([](auto& b) {
          b.set("denominator", List{1, -0.5}).set("density", 1.0);
        }) == "density and density_at belong together");
  CHECK(refused([](auto& b) {
          b.set("denominator", List{1, -0.5}).set("density", 1.0).set("density_at", 1.0).set("std", 1.0);
        }) == "std is given as well as density; allowed: one of the two");
  CHECK(refused([](auto& b) {
          b.set("numerator", List{1, 1}).set("denominator", List{1, 0}).set("density", 1.0).set("density_at", 500.0);
        }) == "the noise filter has no output at density_at, 500 Hz");
}
