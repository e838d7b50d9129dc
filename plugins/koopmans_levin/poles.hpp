#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "solution.hpp"

namespace bodeflow::koopmans_levin {

/// The covariance of real and imaginary part of each root z of c_0 z^n + .. + c_n, by first-order propagation:
/// dz/dc_i = -z^(n-i) / P'(z). It grows without bound where roots fall together. covariance: of c_0 .. c_n, zeros for those that
/// are fixed.
std::vector<Eigen::Matrix2d> root_covariance(const Eigen::VectorXd& polynomial, const Eigen::MatrixXd& covariance,
                                             const Eigen::VectorXcd& roots);

/// A pole of a discrete-time model, and the pole of the continuous-time system that it samples.
struct Pole {
  std::complex<double> z;
  std::complex<double> s_rad_s;  ///< ln(z) / sample_time, the imaginary part within +- pi / sample_time
  Eigen::Matrix2d z_covariance;  ///< of Re z and Im z
  double frequency_hz = 0.0;     ///< |s| / 2 pi
  double frequency_std_hz = 0.0;
  double damping_ratio = 0.0;   ///< -Re s / |s|; below 0 where unstable
  double real_std_rad_s = 0.0;  ///< standard deviations of Re s and Im s
  double imaginary_std_rad_s = 0.0;
};

/// The poles of A, in conjugate pairs by magnitude of z, with standard deviations by first-order propagation.
///
/// covariance: of a_1 .. a_n in its first n rows and columns. ds/da_i = -z^(n-i) / (A'(z) z sample_time): it grows without bound
/// where poles fall together, and it is not defined for a pole at z = 0: its s is -infinity. The paper's (62) leaves out the
/// sampling frequency: its Table III is in 100 rad/s. Errors: a sample time that is not positive; a covariance smaller than n x
/// n; those of numerics::roots.
Expected<std::vector<Pole>> poles(const Model& model, const Eigen::MatrixXd& covariance, double sample_time);

}  // namespace bodeflow::koopmans_levin
