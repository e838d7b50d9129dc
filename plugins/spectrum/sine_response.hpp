#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <cstdint>

namespace bodeflow::spectrum {

/// The response at one frequency from a sine. Vectors: one entry an output.
struct SineResponse {
  std::int64_t windows = 0;           ///< P
  std::complex<double> input_mean;    ///< U, of the amplitude a in a cos(theta n + phi): a exp(j phi)
  double input_variance = 0.0;        ///< of U
  Eigen::VectorXcd output_mean;       ///< Y_i
  Eigen::VectorXd output_variance;    ///< of Y_i
  Eigen::VectorXcd cross_covariance;  ///< of Y_i and U: E{dY conj(dU)}
  Eigen::VectorXcd response;          ///< G_i = Y_i / U
  Eigen::VectorXd variance;           ///< of G_i, complex: E|dG|^2
};

/// The response from the complex amplitudes of input (P values) and outputs (P x outputs) in P windows of a steady state.
///
/// Means, their variances and their covariance from the scatter between the windows, divisor P (P - 1), with P - 1 complex
/// degrees of freedom; G = Y / U; var G = (var_y + |G|^2 var_u - 2 Re(conj(G) cov_yu)) / |U|^2, to first order in the noise.
/// Assumptions: settled (what is left of a transient moves G and inflates the variance), noise independent between windows, |U|
/// well above its own standard deviation. A drift over the windows and a harmonic distortion of the fundamental do not show in
/// the variance. Reference: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012,
/// chapter 2. Errors: fewer than 2 windows; an input of zero; overflow.
Expected<SineResponse> sine_response(const Eigen::Ref<const Eigen::VectorXcd>& input,
                                     const Eigen::Ref<const Eigen::MatrixXcd>& output);

}  // namespace bodeflow::spectrum
