#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>

#include "plane.hpp"

namespace bodeflow::sanathanan_koerner {

/// Responses n_i(z) / d(z) with one denominator, as coefficients in polynomials q_j that obey z q_j = sum h_ij q_i. No powers of
/// s or z anywhere: that is what keeps digits at high orders.
struct Rational {
  Plane plane;
  Eigen::MatrixXd hessenberg;   ///< h, M + 1 x M
  Eigen::VectorXd denominator;  ///< c_0 .. c_M
  Eigen::MatrixXd numerators;   ///< b, M + 1 x channels
  double scale = 1.0;           ///< q_0 = 1 / scale

  Eigen::Index order() const { return hessenberg.cols(); }
  Eigen::Index channels() const { return numerators.cols(); }
};

/// The matrix whose eigenvalues are the roots of sum c_j q_j: h without its last row, less h_{M+1,M}/c_M c e_M'.
/// Errors: a leading coefficient so small that the degree is less.
Expected<Eigen::MatrixXd> colleague_matrix(const Eigen::MatrixXd& hessenberg, const Eigen::VectorXd& coefficients);

/// The roots of sum c_j q_j in z. Errors: as colleague_matrix, and eigenvalues that were not found.
Expected<Eigen::VectorXcd> roots_of(const Eigen::MatrixXd& hessenberg, const Eigen::VectorXd& coefficients);

/// A realisation with one input, an output for each channel and as many states as the order, of s or z as the plane is.
///
/// Method: states q_j/d, then the bilinear map of the matrices with z = (a + s)/(a - s); neither poles nor coefficients of powers
/// are formed. Errors: those of colleague_matrix; a pole at z = -1, which is infinite in continuous time.
Expected<numerics::StateSpace> state_space(const Rational& model);

/// The realisation with the channels as a matrix of `inputs` columns (channel = input * outputs + output): the states of each
/// input apart, or of each output where these are fewer. Not minimal where the residues have a lower rank. Errors: those of
/// state_space; channels that are no whole number of columns.
Expected<numerics::StateSpace> state_space(const Rational& model, Eigen::Index inputs);

/// The same from a realisation of one input whose outputs are the channels.
numerics::StateSpace reshaped(const numerics::StateSpace& one_input, Eigen::Index inputs);

}  // namespace bodeflow::sanathanan_koerner
