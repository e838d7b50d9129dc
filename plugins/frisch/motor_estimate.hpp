#pragma once

#include <string>
#include <vector>

#include "band.hpp"
#include "corrected_response.hpp"
#include "hold.hpp"
#include "noise_variances.hpp"

namespace bodeflow::frisch {

/// How the motor is estimated from spectra.
enum class Method {
  maximum_likelihood,  ///< noise pooled over the lines of each band, errors-in-variables maximum likelihood
  frisch,              ///< noise by the Frisch scheme, two passes; least squares to the corrected response
  none                 ///< the same without correction: what the paper compares with
};

struct MotorSettings {
  Method method = Method::maximum_likelihood;
  ResponseForm form = ResponseForm::output;  ///< of frisch and none
  double outliers = 0.08;                    ///< frisch: fraction of the lines that the second pass leaves out
  bool correlated_noise = true;              ///< maximum likelihood: use the covariance of the noises of input and output
  Sampling sampling;
};

/// A motor model with what it was fitted to.
struct MotorEstimate {
  MotorFit fit;
  Eigen::VectorXd omega;      ///< rad/s, rising from band to band
  Eigen::VectorXcd response;  ///< as it was fitted: corrected, hold and delay taken off
  Eigen::VectorXd variance;   ///< of `response`, E|dG|^2; empty for frisch and none, which know no variance of it
  /// Of the samples, one a band, as the method found them; empty: the method has none.
  std::vector<double> input_noise_variance, output_noise_variance;
};

/// The estimate from all bands together, in order of frequency. Every band has its own noise.
/// Errors: no band; for frisch and none a band without products of windows; those of the fits, with the band where one causes
/// them.
Expected<MotorEstimate> estimate_motor(std::vector<Band> bands, const MotorSettings& settings);

}  // namespace bodeflow::frisch
