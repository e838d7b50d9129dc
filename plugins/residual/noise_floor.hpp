#pragma once

#include <Eigen/Core>

#include "expected.hpp"

namespace bodeflow::residual {

/// The power of the noise over frequency, found without any model from what lies between the lines of a periodic signal.
class NoiseFloor {
 public:
  static constexpr int kTerms = 3;

  /// The floor under the powers of bins that hold noise alone (frequencies in Hz, rising).
  ///
  /// Method: median of the powers in up to 12 bands, over ln 2, which tones and the skirts of strong lines hardly move; a
  /// parabola over frequency through the logarithms of these levels. In logarithms the level of a band of n bins has the variance
  /// 1 / (n ln^2 2), that of the median of an exponential distribution.
  /// Noise that is coloured so strongly that a parabola does not follow it is not described.
  /// Errors: fewer than 60 bins; powers that are not above 0 in most bins.
  static Expected<NoiseFloor> from_bins(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& power);

  /// E |noise|^2 at that frequency.
  double at(double frequency_hz) const;
  Eigen::VectorXd at(const Eigen::VectorXd& frequency_hz) const;

  /// The variance of the relative error of the floor's mean over these frequencies; with nu = 2 / variance it counts as nu
  /// degrees of freedom. 0 without frequencies.
  double relative_variance(const Eigen::VectorXd& frequency_hz) const;

 private:
  Eigen::Vector3d basis(double frequency_hz) const;

  double low_hz_ = 0.0;
  double high_hz_ = 1.0;
  Eigen::Vector3d coefficients_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace bodeflow::residual
