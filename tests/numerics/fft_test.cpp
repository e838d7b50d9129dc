#include "bodeflow/numerics/fft.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"

using bodeflow::numerics::ComplexDft;
using bodeflow::numerics::RealDft;

namespace {

// Rounding of an N-point transform grows like log N; 1e-13 of the largest line holds with room for N <= 1000.
constexpr double kRounding = 1e-13;

// Angles reduced exactly in integers before the cosine, so that the reference is the better of the two.
Eigen::VectorXcd direct_dft(const Eigen::VectorXcd& x) {
  const Eigen::Index n_samples = x.size();
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(n_samples);
  for (Eigen::Index k = 0; k < n_samples; ++k) {
    for (Eigen::Index n = 0; n < n_samples; ++n) {
      const double angle = -2.0 * std::numbers::pi * static_cast<double>((k * n) % n_samples) / static_cast<double>(n_samples);
      spectrum[k] += x[n] * std::complex<double>(std::cos(angle), std::sin(angle));
    }
  }
  return spectrum;
}

// A sequence without symmetry: fractional parts of the golden ratio's multiples.
Eigen::VectorXd sequence(Eigen::Index n_samples, double seed) {
  Eigen::VectorXd x(n_samples);
  for (Eigen::Index n = 0; n < n_samples; ++n)
    x[n] = std::fmod(seed + 0.6180339887498949 * static_cast<double>(n + 1), 1.0) - 0.4;
  return x;
}

Eigen::VectorXcd complex_sequence(Eigen::Index n_samples) {
  Eigen::VectorXcd x(n_samples);
  x.real() = sequence(n_samples, 0.1);
  x.imag() = sequence(n_samples, 0.7) * 1.3;
  return x;
}

}  // namespace

TEST_CASE("a real transform of any length equals the direct sum") {
  const Eigen::Index length = GENERATE(1, 2, 3, 4, 5, 7, 8, 30, 97, 128, 210, 251, 640, 997);
  const Eigen::VectorXd x = sequence(length, 0.3);
  const Eigen::VectorXcd expected = direct_dft(x.cast<std::complex<double>>());
  const double bound = kRounding * expected.cwiseAbs().maxCoeff() * 10;

  const Eigen::VectorXcd full = bodeflow::numerics::dft(x);
  REQUIRE(full.size() == length);
  CHECK((full - expected).cwiseAbs().maxCoeff() < bound);
  const Eigen::VectorXcd half = bodeflow::numerics::half_dft(x);
  REQUIRE(half.size() == length / 2 + 1);
  CHECK((half - expected.head(half.size())).cwiseAbs().maxCoeff() < bound);
}

TEST_CASE("a complex transform of any length equals the direct sum, and its inverse gives the sequence back") {
  const Eigen::Index length = GENERATE(1, 2, 3, 5, 8, 31, 96, 128, 243, 641);
  const Eigen::VectorXcd x = complex_sequence(length);
  const Eigen::VectorXcd expected = direct_dft(x);
  const Eigen::VectorXcd spectrum = bodeflow::numerics::dft(x);
  CHECK((spectrum - expected).cwiseAbs().maxCoeff() < 10 * kRounding * expected.cwiseAbs().maxCoeff());
  CHECK((bodeflow::numerics::inverse_dft(spectrum) - x).cwiseAbs().maxCoeff() < kRounding);
}

TEST_CASE("a line of a whole number of periods stands alone in its bin") {
  const Eigen::Index length = 1000;
  Eigen::VectorXd x(length);
  for (Eigen::Index n = 0; n < length; ++n) {
    x[n] = 3.0 * std::cos(2 * std::numbers::pi * static_cast<double>((17 * n) % length) / static_cast<double>(length) + 0.5);
  }
  Eigen::VectorXcd half = bodeflow::numerics::half_dft(x) * (2.0 / static_cast<double>(length));
  CHECK(std::abs(half[17] - std::polar(3.0, 0.5)) < 1e-14);
  half[17] = 0;
  CHECK(half.cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("a plan used again gives the same bits, wherever the samples stand in memory") {
  const Eigen::Index length = 240;
  const Eigen::VectorXd x = sequence(length, 0.2);
  RealDft transform(length);
  REQUIRE(transform.length() == length);
  REQUIRE(transform.lines() == 121);
  Eigen::VectorXcd first(transform.lines());
  transform.forward(x, first);
  Eigen::VectorXd shifted(length + 1);  // off the 16-byte grid
  shifted.tail(length) = x;
  Eigen::VectorXcd second(transform.lines());
  transform.forward(shifted.tail(length), second);
  RealDft moved = std::move(transform);
  Eigen::VectorXcd third(moved.lines());
  moved.forward(x, third);
  CHECK(first == second);
  CHECK(first == third);

  ComplexDft in_place(8);
  Eigen::VectorXcd data = complex_sequence(8);
  const Eigen::VectorXcd expected = bodeflow::numerics::dft(data);
  in_place.forward(data, data);
  CHECK(data == expected);
}

TEST_CASE("a transform in place of its samples gives the bits of one that copies") {
  for (const Eigen::Index n : {1, 2, 37, 64, 1000}) {
    RealDft dft(n), other(n);
    const Eigen::VectorXd x = sequence(n, 0.3);
    Eigen::VectorXcd copied(dft.lines());
    other.forward(x, copied);
    for (int again = 0; again < 2; ++again) {
      dft.samples() = x;
      const auto spectrum = dft.transform();
      REQUIRE(spectrum.size() == dft.lines());
      CHECK(spectrum == copied);
    }
  }
}

TEST_CASE("an empty sequence has an empty spectrum") {
  CHECK(bodeflow::numerics::dft(Eigen::VectorXd()).size() == 0);
  CHECK(bodeflow::numerics::dft(Eigen::VectorXcd()).size() == 0);
  CHECK(bodeflow::numerics::half_dft(Eigen::VectorXd()).size() == 0);
  CHECK(bodeflow::numerics::inverse_dft(Eigen::VectorXcd()).size() == 0);
}
