#pragma once

#include <Eigen/Core>
#include <string>

#include "motor_model.hpp"

namespace bodeflow::frisch {

/// A motor model fitted to data.
struct MotorFit {
  MotorModel model;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of gamma, alpha, Lm_beta, sigma
  /// Expected error of each estimate beyond the scatter, in the parameter's unit: the second-order term that the curvature of the
  /// model adds. It is reported and not taken off.
  Eigen::Vector4d bias = Eigen::Vector4d::Zero();
  double cost = 0.0;
  double expected_cost = 0.0;  ///< NaN where the noise is not known
  bool converged = false;
  std::string reason;  ///< why the search ended
};

/// Lower and upper end of the interval that holds each true parameter with probability `confidence`: p exp(-+ q std(p)/p), which
/// stays positive, as the parameters are.
struct Intervals {
  Eigen::Vector4d lower;
  Eigen::Vector4d upper;
};
Intervals intervals(const MotorFit& fit, double confidence = 0.95);

/// The least-squares fit to a response: min sum_k weight_k |response_k - G(j omega_k)|^2 over gamma, alpha, Lm_beta, sigma, all
/// positive. The paper takes weights of 1, by which the low band decides, where |G| is large.
///
/// Method: Levenberg-Marquardt over logarithms, from motor_start. Covariance: (J^T J)^-1 J^T R J (J^T J)^-1 with R from the
/// squared residuals of the lines, scaled by 2K/(2K - 4): right also where lines differ in noise. It knows nothing of the bias of
/// the response itself (see corrected_response). Errors: those of motor_start and levenberg_marquardt; weights that are negative
/// or not one a line; fewer than 3 lines.
Expected<MotorFit> fit_motor(const Eigen::VectorXd& omega, const Eigen::VectorXcd& response, const Eigen::VectorXd& weight);

/// The errors-in-variables maximum likelihood fit to mean spectra, the recommended method:
///   min sum_k |Y_k - G U_k|^2 / (var Y_k + |G|^2 var U_k - 2 Re(conj(G) cov(Y, U)_k)).
/// Twice the cost is chi-squared with 2K - 4 degrees of freedom: expected cost K - 2.
/// Scatter within 7 % of the Cramer-Rao bound, no bias but the reported one, some hundredths of a deviation.
/// Method: as fit_motor, from the response Y/U. Covariance: (J^T J)^-1 / 2.
/// Reference: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, chapter 9. Bias: M. J.
/// Box, J. Royal Statistical Society B 33 (1971) 171.
/// Errors: as fit_motor; a variance that is negative or zero at both signals.
Expected<MotorFit> fit_motor_likelihood(const MeanSpectra& spectra);

}  // namespace bodeflow::frisch
