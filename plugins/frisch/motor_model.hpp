#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "windows.hpp"

namespace bodeflow::frisch {

/// One phase of an induction motor at standstill, from stator voltage to stator current (equation (17) of the paper):
///   G(s) = (s + alpha)/sigma / (s^2 + s (gamma + alpha) + alpha (gamma - alpha Lm_beta)),
/// gamma = Rs/sigma + alpha Lm_beta [1/s], alpha = Rr/Lr [1/s], Lm_beta = Lm^2/(sigma Lr) [1], sigma = Ls - Lm^2/Lr [H].
/// Equal to the impedance 1/G = Rs + sigma s + sigma Lm_beta alpha s/(s + alpha).
struct MotorModel {
  double gamma = 0.0;
  double alpha = 0.0;
  double lm_beta = 0.0;
  double sigma = 0.0;

  static constexpr Eigen::Index kParameters = 4;
  Eigen::Vector4d vector() const { return {gamma, alpha, lm_beta, sigma}; }
  static MotorModel of(const Eigen::Vector4d& p) { return {p[0], p[1], p[2], p[3]}; }
};

/// "gamma", "alpha", "Lm_beta", "sigma": the order of parameters in vectors and covariances.
const std::vector<std::string>& motor_parameter_names();

/// G(j omega), omega in rad/s.
std::complex<double> response(const MotorModel& model, double omega);
Eigen::VectorXcd response(const MotorModel& model, const Eigen::VectorXd& omega);

/// Numerator and denominator of G(s), descending powers, denominator monic.
Eigen::Vector2d transfer_numerator(const MotorModel& model);
Eigen::Vector3d transfer_denominator(const MotorModel& model);

/// The poles [rad/s], the slow one first: real and apart, as all parameters are positive.
Eigen::Vector2d poles(const MotorModel& model);

/// G(j omega) and its derivatives by the logarithms of the parameters.
struct ResponseSlope {
  std::complex<double> value;
  Eigen::Vector4cd slope;
};
ResponseSlope response_slope(const MotorModel& model, double omega);

/// A model near the measured response, as a start for a fit: the linearised least squares of Sanathanan & Koerner, three times
/// reweighted, frequencies scaled; Levy's estimate alone, the first of them, is useless here. Parameters that come out at or
/// below 0 are replaced by ones of the band's scale. Reference: C. K. Sanathanan, J. Koerner, IEEE Trans. Automatic Control 8
/// (1963) 56. Errors: fewer than 2 lines; sizes that differ; values or frequencies that are not finite, frequencies not above 0.
Expected<MotorModel> motor_start(const Eigen::VectorXd& omega, const Eigen::VectorXcd& response);

}  // namespace bodeflow::frisch
