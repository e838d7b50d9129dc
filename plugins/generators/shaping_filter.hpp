#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/linear_system.hpp>

/// Filters that colour white noise, with one input, one output and a sample time of 1.
namespace bodeflow::generators {

/// H(z) = numerator / denominator, descending powers. Errors: improper, zero or not finite polynomials, a pole with |z| >= 1.
numerics::Expected<numerics::StateSpace> rational_filter(const Eigen::VectorXd& numerator, const Eigen::VectorXd& denominator);

/// A filter whose power |H|^2 falls with f^-exponent from `lowest` on, in cycles a sample, and is flat below.
/// Method: real poles at lowest * 10^(i/3), each with a zero at 10^(exponent/6) times its frequency (Plaszczynski 2007), z =
/// exp(-2 pi f). Within 0.6 dB of the power law from 3 * lowest to 0.2, up to 4 dB above it at 0.5 (the exponent 2), where
/// sampling folds. 0 < exponent <= 2, 0 < lowest < 0.5. Reference: S. Plaszczynski, "Generating long streams of 1/f^alpha noise",
/// Fluct. Noise Lett. 7, 2007, doi:10.1142/S0219477507003635.
numerics::StateSpace power_law_filter(double exponent, double lowest);

/// The covariance P = A P A' + B B' of the states under white noise of variance 1 that has lasted for ever. A is stable.
/// Method: doubling (R. A. Smith, SIAM J. Appl. Math. 16, 1968): P_2m = P_m + A^m P_m A^m'.
Eigen::MatrixXd stationary_covariance(const numerics::StateSpace& filter);

/// A lower triangular L with L L' = P for a covariance P, which may be singular: columns without variance are zero.
Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& covariance);

/// The standard deviation of the output under white noise of variance 1.
double output_std(const numerics::StateSpace& filter, const Eigen::MatrixXd& covariance);

/// |H| at a frequency in cycles a sample.
double gain_at(const numerics::StateSpace& filter, double frequency);

}  // namespace bodeflow::generators
