#pragma once

#include <Eigen/Core>

#include "expected.hpp"

namespace bodeflow::residual {

/// The level of the noise over frequency, from bins of a spectrum that hold noise alone but for tones and skirts.
class FloorOfBins {
 public:
  /// The floor of |Y|^2 at these frequencies (rising), one value a bin.
  ///
  /// Method: the median over ln 2 in up to 24 bands of as many bins each, which tones and skirts hardly move; in logarithms its
  /// variance is 1 / (n ln^2 2), that of the median of an exponential distribution. A sequence of levels through the bands
  /// minimises the weighted squares and lambda times the squares of its third differences, so that it follows coloured noise and
  /// becomes a parabola for white one; lambda is the one of least expected error (C. L. Mallows, Some comments on Cp,
  /// Technometrics 15 (1973) 661). Between the bands' middles it runs monotone (F. N. Fritsch, R. E. Carlson, Monotone piecewise
  /// cubic interpolation, SIAM J. Numer. Anal. 17 (1980) 238), beyond them straight. Noise that changes within a band by more
  /// than its own scatter is not described. Errors: fewer than 60 bins; powers that are not above 0 in most bins.
  static Expected<FloorOfBins> make(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& power);

  /// E |noise|^2 at that frequency.
  double at(double frequency_hz) const;
  Eigen::VectorXd at(const Eigen::VectorXd& frequency_hz) const;

  /// The variance of the relative error of the floor's mean over these frequencies; with nu = 2 / variance it counts as nu
  /// degrees of freedom. 0 without frequencies.
  double relative_variance(const Eigen::VectorXd& frequency_hz) const;
  /// The same of a mean with weights.
  double relative_variance(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& weight) const;

 private:
  Eigen::VectorXd middle_hz_, level_, slope_;  ///< of the logarithm, a band each
  Eigen::MatrixXd covariance_;                 ///< of `level_`
};

}  // namespace bodeflow::residual
