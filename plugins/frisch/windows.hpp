#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/error.hpp>
#include <vector>

namespace bodeflow::frisch {

using numerics::Expected;
using numerics::refused;

/// Spectra of one signal at chosen lines in windows of one period: lines x windows.
/// X(k, r) = 1/sqrt(N) sum_t x(start_r + t) exp(-2 pi i k (start_r + t) / N), start_r = r step: unitary, so white noise of
/// variance v has E|X|^2 = v, and referred to one time, so windows of a periodic signal agree whatever the step. Errors: a record
/// shorter than a period, a step or a period that is not positive, a line outside 1 .. (N-1)/2, a sample that is not finite.
Expected<Eigen::MatrixXcd> window_spectra(const Eigen::Ref<const Eigen::VectorXd>& record, Eigen::Index period, Eigen::Index step,
                                          const std::vector<Eigen::Index>& lines);

/// Means over windows of [U Y]^H-products at each line: E|U|^2, E|Y|^2, E(Y conj U).
///
/// The mean must be of the products: products of mean spectra make each matrix singular, with no noise left to find.
/// Overlapping windows (step below the period) are legitimate here and worth up to 11 windows for 8 periods; a step of half a
/// period gives nearly all of it.
struct PowerSpectra {
  Eigen::VectorXd uu;
  Eigen::VectorXd yy;
  Eigen::VectorXcd yu;

  Eigen::Index lines() const { return uu.size(); }
};

/// Errors: sizes that differ, no window.
Expected<PowerSpectra> power_spectra(const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output);

/// Mean spectra at each line and the covariance of the noise on these means.
struct MeanSpectra {
  Eigen::VectorXd omega;            ///< rad/s
  Eigen::VectorXcd input;           ///< U
  Eigen::VectorXcd output;          ///< Y
  Eigen::VectorXd input_variance;   ///< E|dU|^2
  Eigen::VectorXd output_variance;  ///< E|dY|^2
  Eigen::VectorXcd covariance;      ///< E(dY conj dU)

  Eigen::Index lines() const { return omega.size(); }
};

/// The noise of one window, the same at all lines.
struct PooledNoise {
  double input_variance = 0.0;
  double output_variance = 0.0;
  std::complex<double> covariance;  ///< E(dY conj dU)
  double degrees_of_freedom = 0.0;  ///< complex ones: lines (windows - 1)
};

/// The scatter of the windows about their mean, pooled over the lines: unbiased, and up to 20 times less scattered than the
/// Frisch scheme's variances. Windows must not overlap.
/// Assumption: noise of the same variance at all lines of the band. Reference: J. Schoukens et al., Automatica 33 (1997) 1073.
/// Errors: sizes that differ, fewer than 2 windows.
Expected<PooledNoise> pooled_noise(const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output);

/// The means over windows that do not overlap, with the variance of `noise` divided by their number. omega: one a line, rad/s.
/// with_covariance: false takes the noises of input and output as uncorrelated. Errors: sizes that differ, no window.
Expected<MeanSpectra> mean_spectra(const Eigen::VectorXd& omega, const Eigen::MatrixXcd& input, const Eigen::MatrixXcd& output,
                                   const PooledNoise& noise, bool with_covariance = true);

/// Lines of two bands, one after the other.
MeanSpectra joined(const MeanSpectra& first, const MeanSpectra& second);

}  // namespace bodeflow::frisch
