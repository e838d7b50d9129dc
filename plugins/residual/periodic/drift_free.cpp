#include "periodic/drift_free.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kLeastPeriods = 4;
// Deviations by which the floor of all bins has to stand above.
constexpr double kAbove = 4.0;

/// Orthonormal polynomials of degree 2 .. periods - 1 over 0 .. periods - 1, one a row.
Eigen::MatrixXd contrasts(Eigen::Index periods) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(periods, -1.0, 1.0);
  Eigen::MatrixXd powers(periods, periods);
  powers.col(0).setOnes();
  for (Eigen::Index d = 1; d < periods; ++d) {
    powers.col(d) = powers.col(d - 1).cwiseProduct(x);
    for (int twice = 0; twice < 2; ++twice)
      for (Eigen::Index e = 0; e < d; ++e)
        powers.col(d) -= powers.col(e).dot(powers.col(d)) / powers.col(e).squaredNorm() * powers.col(e);
    powers.col(d).normalize();
  }
  return powers.rightCols(periods - 2).transpose();
}

}  // namespace

Expected<FloorOfBins> drift_free_floor(const Eigen::VectorXd& samples, Eigen::Index periods, Eigen::Index lines, double line_hz) {
  if (periods < kLeastPeriods) return refused("a floor without drift needs 4 periods or more");
  const Eigen::Index period = samples.size() / periods, degrees = periods - 2;
  Eigen::MatrixXcd of_period(periods, lines);
  numerics::RealDft dft(period);
  Eigen::VectorXcd spectrum(dft.lines());
  for (Eigen::Index p = 0; p < periods; ++p) {
    dft.forward(samples.segment(p * period, period), spectrum);
    of_period.row(p) = spectrum.head(lines).transpose();
  }
  const Eigen::MatrixXcd rest = contrasts(periods) * of_period;
  // As large as in a bin of the whole record: its coefficients have the variance of a period's over the number of periods.
  const double scale = 1.0 / (static_cast<double>(period) * static_cast<double>(period) * static_cast<double>(periods));
  Eigen::VectorXd power((lines - 1) * degrees), frequency(power.size());
  for (Eigen::Index k = 1; k < lines; ++k) {
    power.segment((k - 1) * degrees, degrees) = scale * rest.col(k).cwiseAbs2();
    frequency.segment((k - 1) * degrees, degrees).setConstant(static_cast<double>(k) * line_hz);
  }
  return FloorOfBins::make(frequency, power);
}

const FloorOfBins& lower_floor(const FloorOfBins& of_bins, const FloorOfBins& drift_free, const Eigen::VectorXd& frequency_hz) {
  const double above = (of_bins.at(frequency_hz).array() / drift_free.at(frequency_hz).array()).log().mean();
  const double spread = std::sqrt(of_bins.relative_variance(frequency_hz));
  return above > kAbove * spread ? drift_free : of_bins;
}

}  // namespace bodeflow::residual
