// Responses whose neighbouring lines share data: intervals, cost and whiteness beside what they claim.

#include <Eigen/Dense>
#include <bodeflow/numerics/fft.hpp>

#include "catch.hpp"
#include "simulated.hpp"
#include "spectrum/local_polynomial.hpp"
#include "spectrum/welch.hpp"
#include "spectrum/window.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

// (0.5 z - 0.2) / (z^2 - 1.2 z + 0.52): b1, b0, a1, a0.
const Eigen::Vector4d kTruth(0.5, -0.2, -1.2, 0.52);

/// White noise and what the plant answers in white noise, in columns.
Eigen::MatrixXd recorded(Eigen::Index samples, numerics::Random& random) {
  Eigen::MatrixXd x(samples, 2);
  double u1 = 0.0, u2 = 0.0, y1 = 0.0, y2 = 0.0;
  for (Eigen::Index n = 0; n < samples; ++n) {
    const double u = random.normal(), y = 0.5 * u1 - 0.2 * u2 + 1.2 * y1 - 0.52 * y2;
    x.row(n) << u, y + 0.1 * random.normal();
    u2 = std::exchange(u1, u);
    y2 = std::exchange(y1, y);
  }
  return x;
}

Spectra spectra_from(const std::vector<std::int64_t>& lines, double samples, const Eigen::MatrixXcd& g,
                     const Eigen::MatrixXd& v) {
  Eigen::VectorXd omega(static_cast<Eigen::Index>(lines.size()));
  for (Eigen::Index k = 0; k < omega.size(); ++k)
    omega[k] = 2.0 * std::numbers::pi * static_cast<double>(lines[static_cast<std::size_t>(k)]) / samples;
  Spectra s = spectra_of(omega, g, v);
  s.sample_time_s = 1.0;
  return s;
}

Spectra by_local_polynomial(numerics::Random& random) {
  constexpr Eigen::Index kSamples = 600;
  const Eigen::MatrixXd x = recorded(kSamples, random);
  spectrum::RecordSpectra r;
  r.samples = kSamples;
  numerics::RealDft dft(kSamples);
  r.input.resize(dft.lines(), 1);
  r.output.resize(dft.lines(), 1);
  dft.forward(x.col(0), r.input.col(0));
  dft.forward(x.col(1), r.output.col(0));
  std::vector<std::int64_t> lines(kSamples / 2 - 1);
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k] = static_cast<std::int64_t>(k + 1);
  spectrum::LocalPolynomial settings;
  const auto e = spectrum::local_polynomial(r, lines, settings);
  REQUIRE(e);
  Spectra s = spectra_from(e->lines, kSamples, e->response, e->variance);
  s.degrees_of_freedom = e->degrees_of_freedom;
  s.correlated_lines = 2 * settings.half_width;
  return s;
}

Spectra by_welch(numerics::Random& random) {
  const Eigen::MatrixXd x = recorded(8192, random);
  spectrum::WelchSettings settings;
  settings.segment = 256;
  settings.hop = 128;
  spectrum::Welch welch(settings, 1, 1);
  for (Eigen::Index n = 0; n + 256 <= x.rows(); n += 128) welch.add(x.middleRows(n, 256));
  const auto e = welch.estimate(spectrum::WelchForm::h1, 1, 127);
  REQUIRE(e);
  Spectra s = spectra_from(e->lines, 256.0, e->response, e->variance);
  s.degrees_of_freedom = e->degrees_of_freedom;
  s.correlated_lines = spectrum::correlated_lines("hann");
  return s;
}

/// Shares of runs: intervals of 95 % with the truth in them, of all parameters; costs and residuals refused at 1 %.
struct Shares {
  double covered = 0.0, costs_refused = 0.0, whiteness_refused = 0.0;
};

template <class Data>
Shares run(int count, Data data, bool told) {
  Shares shares;
  const double one = 1.0 / count;
  for (int n = 0; n < count; ++n) {
    numerics::Random random = numerics::Random::stream(505, static_cast<std::uint64_t>(n));
    Spectra spectra = data(random);
    if (!told) spectra.correlated_lines = 0;
    Settings s = settings(Domain::z, 2);
    s.numerator_orders = {1};
    s.starts = 1;
    const auto id = identify(spectra, s);
    REQUIRE(id);
    const Coefficients c =
        coefficients_of(id->fit.lines, id->fit.structure, id->fit.minimum.estimate, 0, id->fit.models[0], id->covariance_root);
    const Eigen::ArrayXd away = (c.values - kTruth).cwiseAbs().array() / c.covariance.diagonal().array().sqrt();
    shares.covered += one * (away < 1.959964).cast<double>().mean();
    const double p = id->test.probability.value();
    shares.costs_refused += p < 0.005 || p > 0.995 ? one : 0.0;
    shares.whiteness_refused += id->whiteness[0].value().probability < 0.01 ? one : 0.0;
  }
  UNSCOPED_INFO("covered " << shares.covered << ", costs refused " << shares.costs_refused << ", whiteness refused "
                           << shares.whiteness_refused);
  return shares;
}

void check(const Shares& s) {
  CHECK(s.covered >= 0.92);
  CHECK(s.covered <= 0.98);
  CHECK(s.costs_refused <= 0.1);
  CHECK(s.whiteness_refused <= 0.06);
}

}  // namespace

TEST_CASE("maximum likelihood: intervals from local polynomials hold the truth as often as they claim") {
  check(run(100, by_local_polynomial, true));
}

TEST_CASE("maximum likelihood: intervals from averaged segments hold the truth as often as they claim") {
  check(run(100, by_welch, true));
}

TEST_CASE("maximum likelihood: local polynomials taken as independent lines are refused by their whiteness") {
  const Shares s = run(30, by_local_polynomial, false);
  CHECK(s.whiteness_refused > 0.9);
  CHECK(s.covered < 0.85);
}
