// A drive with a flexible coupling, from current to both angles.

#include <bodeflow/numerics/fft.hpp>

#include "../spectrum/data.hpp"
#include "catch.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

constexpr Eigen::Index kPeriod = 2500, kFirst = 11, kLines = 240, kPeriods = 19;

// Spectra of the 19 periods after the first, lines x periods.
Eigen::MatrixXcd period_spectra(const std::vector<double>& samples) {
  Eigen::MatrixXcd all(kLines, kPeriods);
  numerics::RealDft dft(kPeriod);
  Eigen::VectorXcd spectrum(dft.lines());
  for (Eigen::Index p = 0; p < kPeriods; ++p) {
    dft.forward(Eigen::Map<const Eigen::VectorXd>(samples.data() + (p + 1) * kPeriod, kPeriod), spectrum);
    all.col(p) = spectrum.segment(kFirst, kLines) / static_cast<double>(kPeriod);
  }
  return all;
}

Spectra bench_spectra(const Table& table) {
  const Eigen::MatrixXcd u = period_spectra(table.columns[0]);
  Spectra s = spectra_of(2.0 * std::numbers::pi * even_spaced(11.0, 250.0, kLines), Eigen::MatrixXcd::Zero(kLines, 2),
                         Eigen::MatrixXd::Zero(kLines, 2));
  s.sample_time_s = 1.0 / 2500.0;
  s.degrees_of_freedom = static_cast<double>(kPeriods - 1);
  const double by = 1.0 / static_cast<double>(kPeriods * (kPeriods - 1));
  s.input = u.rowwise().mean();
  const Eigen::MatrixXcd du = u.colwise() - s.input;
  s.input_variance = by * du.rowwise().squaredNorm();
  for (Eigen::Index i = 0; i < 2; ++i) {
    const Eigen::MatrixXcd y = period_spectra(table.columns[static_cast<std::size_t>(i + 1)]);
    s.output.col(i) = y.rowwise().mean();
    const Eigen::MatrixXcd dy = y.colwise() - s.output.col(i);
    s.output_variance.col(i) = by * dy.rowwise().squaredNorm();
    s.covariance.col(i) = by * dy.cwiseProduct(du.conjugate()).rowwise().sum();
  }
  return s;
}

struct BandErrors {
  Eigen::MatrixXd relative, normalised;  // bands x outputs, root mean squares
};

BandErrors band_errors(const Spectra& s, const Eigen::MatrixXcd& model) {
  const Eigen::Index edges[] = {0, 20, 50, 80, 140, 240};  // 11, 31, 61, 91, 151, 251 Hz
  const Eigen::MatrixXcd g = s.response();
  const Eigen::MatrixXd error = (g - model).cwiseAbs2(), relative = error.cwiseQuotient(g.cwiseAbs2());
  const Eigen::MatrixXd normalised = (s.input.cwiseAbs2().asDiagonal() * error).eval().cwiseQuotient(s.error_variance(model));
  BandErrors b{Eigen::MatrixXd(5, 2), Eigen::MatrixXd(5, 2)};
  for (Eigen::Index n = 0; n < 5; ++n) {
    const Eigen::Index size = edges[n + 1] - edges[n];
    b.relative.row(n) = relative.middleRows(edges[n], size).colwise().mean().cwiseSqrt();
    b.normalised.row(n) = normalised.middleRows(edges[n], size).colwise().mean().cwiseSqrt();
  }
  return b;
}

}  // namespace

TEST_CASE(
    "maximum likelihood: the two-mass bench is nearer in every band than by plain least squares, and what remains is told") {
  const auto table = shared_table("motorbench_two_mass/multisine_A.csv", {"iq_A", "theta_motor_rad", "theta_load_rad"});
  if (!table) return;
  const Spectra data = bench_spectra(*table);
  Settings s = settings(Domain::s, 4);
  s.numerator_orders = {2, 1};
  s.estimate_delay = true;
  const auto likelihood = identify(data, s);
  s.weighting = Weighting::even;
  const auto squares = identify(data, s);
  REQUIRE(likelihood);
  REQUIRE(squares);
  const BandErrors ours = band_errors(data, likelihood->fit.response), theirs = band_errors(data, squares->fit.response);
  CAPTURE(ours.relative, theirs.relative, ours.normalised, theirs.normalised);
  CHECK((ours.relative.array() < theirs.relative.array()).all());
  CHECK((ours.normalised.array() < theirs.normalised.array()).all());
  // The published baseline, Sanathanan-Koerner with 4 poles: .135 and .230 over the whole band.
  const Eigen::MatrixXcd g = data.response();
  const Eigen::RowVectorXd whole =
      ((g - likelihood->fit.response).cwiseAbs2().cwiseQuotient(g.cwiseAbs2()).colwise().mean()).cwiseSqrt();
  CHECK(whole[0] < 0.1);
  CHECK(whole[1] < 0.23);
  // Rolling friction and the nonlinear resonance are no noise: the cost says so.
  CHECK(likelihood->test.cost > 100.0 * likelihood->test.expected);
  CHECK(likelihood->covariance_kind == CovarianceKind::residuals);
  const Complex resonance = likelihood->fit.models[0].poles[2];
  CHECK(std::abs(resonance) / (2.0 * std::numbers::pi) == Approx(76.3).margin(0.5));
}
