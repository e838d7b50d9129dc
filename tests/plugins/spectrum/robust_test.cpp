#include <iostream>

#include "catch.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

constexpr int kSamples = 256;
const std::vector<std::int64_t> kLines = lines_of(1, 59, 2);
constexpr double kNoise = 0.3;

/// A filter, a cubic, a filter (Wiener-Hammerstein), in steady state.
Eigen::VectorXd plant(const Eigen::VectorXd& u) {
  const Eigen::VectorXd x = filtered(u, resonance(30.0, 0.4));
  return filtered(x + 0.2 * x.cwiseProduct(x).cwiseProduct(x), resonance(60.0, 0.5));
}

Eigen::VectorXd excitation(numerics::Random& random) { return random_multisine(kSamples, kLines, 0.2, random); }

Moments measured(const Eigen::VectorXd& u, const Eigen::VectorXd& y, int periods, double deviation, numerics::Random& random) {
  AveragingDft average(kSamples, 1);
  for (int p = 0; p < periods; ++p) average.add(u, y + noise(kSamples, deviation, random));
  return *average.moments();
}

struct Truth {
  Eigen::VectorXcd best_linear;
  Eigen::VectorXd nonlinear_variance;
};

/// The best linear approximation and the scatter around it, from many noise-free realisations.
Truth monte_carlo(int runs) {
  const auto lines = static_cast<Eigen::Index>(kLines.size());
  Truth t{Eigen::VectorXcd::Zero(lines), Eigen::VectorXd::Zero(lines)};
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(99, static_cast<std::uint64_t>(run));
    const Eigen::VectorXd u = excitation(random);
    const Eigen::VectorXcd U = numerics::half_dft(u), Y = numerics::half_dft(plant(u));
    for (Eigen::Index i = 0; i < lines; ++i) {
      const Complex G = Y[kLines[static_cast<std::size_t>(i)]] / U[kLines[static_cast<std::size_t>(i)]];
      t.best_linear[i] += G / double(runs);
      t.nonlinear_variance[i] += std::norm(G) / (runs - 1.0);
    }
  }
  t.nonlinear_variance -= t.best_linear.cwiseAbs2() * (runs / (runs - 1.0));
  return t;
}

}  // namespace

TEST_CASE("robust method: noise and nonlinear variance of a Wiener-Hammerstein plant are told apart within 10 %") {
  const Truth truth = monte_carlo(3000);
  const int repeats = 40, M = 10, P = 4;
  const auto lines = static_cast<Eigen::Index>(kLines.size());
  Eigen::VectorXd total = Eigen::VectorXd::Zero(lines), noise_part = total, nonlinear = total, error = total;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    numerics::Random random = numerics::Random::stream(3, static_cast<std::uint64_t>(repeat));
    Measured m{{1, 1, 0}, kSamples, 1, {}};
    for (int r = 0; r < M; ++r) {
      const Eigen::VectorXd u = excitation(random);
      m.parts.push_back(measured(u, plant(u), P, kNoise, random));
    }
    const auto e = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
    REQUIRE(e);
    CHECK(e->realisations == M);
    CHECK(e->periods == P);
    CHECK(e->degrees_of_freedom.minCoeff() == M - 1.0);
    total += e->variance.col(0) / repeats;
    noise_part += e->noise_variance.col(0) / repeats;
    nonlinear += e->nonlinear_variance.col(0) / repeats;
    error += (e->response.col(0) - truth.best_linear).cwiseAbs2() / repeats;
  }
  // Noise of one period has the variance kNoise^2 / N; |U| = 0.1.
  const double noise_truth = kNoise * kNoise / kSamples / 0.01 / (M * P);
  std::cout << "robust method: noise variance " << noise_part.mean() / noise_truth << " of the true one, nonlinear variance "
            << nonlinear.sum() / truth.nonlinear_variance.sum()
            << " of the Monte Carlo one; share of the nonlinear part in the variance " << nonlinear.sum() / M / total.sum()
            << "\n";
  CHECK(noise_part.mean() == Approx(noise_truth).epsilon(0.1));
  CHECK(nonlinear.sum() == Approx(truth.nonlinear_variance.sum()).epsilon(0.1));
  CHECK(total.sum() == Approx(noise_truth * double(lines) + truth.nonlinear_variance.sum() / M).epsilon(0.1));
  CHECK(error.sum() == Approx(total.sum()).epsilon(0.15));  // what it says is what it is
}

TEST_CASE("robust method: one period of each realisation gives the total variance, and no noise") {
  numerics::Random random(5);
  Measured m{{1, 1, 0}, kSamples, 1, {}};
  for (int r = 0; r < 6; ++r) {
    const Eigen::VectorXd u = excitation(random);
    m.parts.push_back(measured(u, plant(u), 1, kNoise, random));
  }
  const auto e = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
  REQUIRE(e);
  CHECK(e->noise_variance.size() == 0);
  CHECK(e->nonlinear_variance.size() == 0);
  CHECK(e->noise_level.size() == 0);
  CHECK(e->variance.minCoeff() > 0.0);
}

TEST_CASE("robust method: a linear plant has no nonlinear variance beyond what chance gives") {
  numerics::Random random(6);
  Measured m{{1, 1, 0}, kSamples, 1, {}};
  for (int r = 0; r < 8; ++r) {
    const Eigen::VectorXd u = excitation(random);
    m.parts.push_back(measured(u, filtered(u, resonance(30.0, 0.4)), 4, kNoise, random));
  }
  const auto e = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
  REQUIRE(e);
  CHECK(e->nonlinear_variance.minCoeff() == 0.0);
  // M (variance - noise) is below the noise variance of one realisation.
  CHECK(e->nonlinear_variance.mean() < 8.0 * e->noise_variance.mean());
  CHECK(e->variance.mean() == Approx(e->noise_variance.mean()).epsilon(0.3));
}

TEST_CASE(
    "reference: equals the plain estimate in one realisation, and is unbiased in a noisy loop where the mean of ratios is not") {
  // Loop: u = r - c y, y = G u + v; with v strong, U = S (R - c V) is noisy and correlated with Y.
  const auto G = resonance(30.0, 0.4);
  const double c = 2.0, deviation = 1.5;
  const int M = 300;
  numerics::Random random(8);
  Measured m{{1, 1, 1}, kSamples, 1, {}};
  for (int r = 0; r < M; ++r) {
    const Eigen::VectorXd ref = random_multisine(kSamples, kLines, 0.2, random);
    AveragingDft average(kSamples, Layout{1, 1, 1});
    for (int p = 0; p < 2; ++p) {
      const Eigen::VectorXd v = noise(kSamples, deviation, random);
      Eigen::MatrixXd frame(kSamples, 3);
      const auto S = [&](int k) { return 1.0 / (1.0 + c * G(k)); };
      frame << filtered(ref - c * v, S), filtered(filtered(ref, G) + v, S), ref;
      average.add(frame);
    }
    m.parts.push_back(*average.moments());
  }
  Measured one = m;
  one.parts.resize(1);
  const auto plain = estimate_response(one, {kLines, 0.0}, Form::errors_in_variables);
  const auto from_reference = estimate_response(one, {kLines, 0.0}, Form::reference);
  REQUIRE(plain);
  REQUIRE(from_reference);
  CHECK((plain->response - from_reference->response).cwiseAbs().maxCoeff() < 1e-10 * plain->response.cwiseAbs().maxCoeff());
  CHECK((plain->variance - from_reference->variance).cwiseAbs().maxCoeff() < 1e-10 * plain->variance.maxCoeff());

  const auto e = estimate_response(m, {kLines, 0.0}, Form::reference);
  REQUIRE(e);
  double chi = 0.0;
  for (std::size_t i = 0; i < kLines.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    chi += std::norm(e->response(row, 0) - G(static_cast<int>(kLines[i]))) / e->variance(row, 0) / double(kLines.size());
  }
  CHECK(chi == Approx(1.0).margin(4.0 / std::sqrt(double(kLines.size()))));
  const auto ratios = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
  REQUIRE(ratios);
  double error_reference = 0.0, error_ratios = 0.0;
  for (std::size_t i = 0; i < kLines.size(); ++i) {
    const Complex truth = G(static_cast<int>(kLines[i]));
    error_reference += std::norm(e->response(static_cast<Eigen::Index>(i), 0) - truth);
    error_ratios += std::norm(ratios->response(static_cast<Eigen::Index>(i), 0) - truth);
  }
  CHECK(error_reference < 0.25 * error_ratios);
}
