#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {

/// The point at which a system is evaluated for a frequency in Hz: s = j 2 pi f, or z = exp(j 2 pi f sample_time).
std::complex<double> frequency_point(double frequency_hz, double sample_time);

/// G at each frequency [Hz], one value a line; at a pole on the axis the value is not finite.
Eigen::VectorXcd frequency_response(const TransferFunction& system, const Eigen::VectorXd& frequency_hz);
Eigen::VectorXcd frequency_response(const ZeroPoleGain& system, const Eigen::VectorXd& frequency_hz);

/// C (x I - A)^-1 B + D at each frequency [Hz]: one outputs x inputs matrix a line. Method: one LU factorisation of the balanced
/// x I - A a line, cost O(lines * states^3).
std::vector<Eigen::MatrixXcd> frequency_response(const StateSpace& system, const Eigen::VectorXd& frequency_hz);

/// The same for many states and lines. Method: A is balanced and brought to Hessenberg form once, then each line is one
/// Hessenberg solve (Laub, "Efficient multivariable frequency response computations", IEEE Trans. Autom. Control 26, 1981); no
/// eigenvectors, whose condition would multiply the rounding error. Cost: O(states^3 + lines * states^2). The orthogonal
/// transformation mixes states: where a response falls many decades below its largest value, `frequency_response` keeps more
/// digits of it.
std::vector<Eigen::MatrixXcd> hessenberg_response(const StateSpace& system, const Eigen::VectorXd& frequency_hz);

}  // namespace bodeflow::numerics
