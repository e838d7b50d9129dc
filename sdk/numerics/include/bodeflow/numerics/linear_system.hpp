#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "bodeflow/numerics/error.hpp"

/// Linear time-invariant systems in three forms. `sample_time` is in seconds; 0 means continuous time.
namespace bodeflow::numerics {

/// G(x) = numerator(x) / denominator(x), descending powers of x = s (continuous) or x = z (discrete).
struct TransferFunction {
  Eigen::VectorXd numerator;
  Eigen::VectorXd denominator;
  double sample_time = 0.0;
};

/// G(x) = gain * prod(x - zeros) / prod(x - poles), in rad/s (continuous) or as values of z (discrete).
struct ZeroPoleGain {
  Eigen::VectorXcd zeros;
  Eigen::VectorXcd poles;
  double gain = 1.0;
  double sample_time = 0.0;
};

/// dx/dt = A x + B u, y = C x + D u (continuous), or x[n+1] = A x[n] + B u[n], y[n] = C x[n] + D u[n] (discrete).
/// A: states x states, B: states x inputs, C: outputs x states, D: outputs x inputs. No states is allowed: y = D u.
struct StateSpace {
  Eigen::MatrixXd A;
  Eigen::MatrixXd B;
  Eigen::MatrixXd C;
  Eigen::MatrixXd D;
  double sample_time = 0.0;

  Eigen::Index states() const { return A.rows(); }
  Eigen::Index inputs() const { return D.cols(); }
  Eigen::Index outputs() const { return D.rows(); }
  bool has_feedthrough() const { return !D.isZero(0.0); }
};

/// The system with those matrices. An empty D stands for zeros, empty A, B and C for a system without states.
/// Errors: sizes that do not fit each other, entries that are not finite.
Expected<StateSpace> make_state_space(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& C,
                                      const Eigen::MatrixXd& D, double sample_time = 0.0);

/// A realisation of the transfer function with as many states as the denominator's degree; nothing is cancelled.
/// Method: up to order 2 the controllable canonical form with the coefficients as they stand, above it the cascade of its poles
/// and zeros, because a companion form loses its digits with the order. Errors: improper, zero or not finite polynomials.
Expected<StateSpace> to_state_space(const TransferFunction& system);

/// A realisation as a cascade of real sections of order 2 (and one of order 1): conjugate poles stand together, each with
/// the zeros nearest to it. Errors: more zeros than poles, a complex root without its conjugate, a gain that is not finite.
Expected<StateSpace> to_state_space(const ZeroPoleGain& system);

/// The poles, zeros and gain of a transfer function. Errors: those of `roots`.
Expected<ZeroPoleGain> to_zero_pole_gain(const TransferFunction& system);

/// Zeros, poles and gain of a system of one input and one output. Method: states that the output fixes are deflated by
/// Householder reflections until the input reaches the output directly (Emami-Naeini & Van Dooren, "Computation of zeros of
/// linear multivariable systems", Automatica 18, 1982); the zeros are then eigenvalues, the gain is the product of what was
/// deflated. An entry below 1e-11 of what stands beside it counts as zero. Nothing is cancelled. Errors: more than one input or
/// output, entries that are not finite.
Expected<ZeroPoleGain> to_zero_pole_gain(const StateSpace& system);

/// The same as polynomials: they lose digits with the order, which a state space keeps. Errors: as above.
Expected<TransferFunction> to_transfer_function(const StateSpace& system);

/// The polynomials of a system given by its roots; the denominator is monic. Errors: those of `split_roots`.
Expected<TransferFunction> to_transfer_function(const ZeroPoleGain& system);

/// The series connection: the outputs of `first` drive `second`; states of `first` come first. Sizes and sample times must fit.
StateSpace series(const StateSpace& first, const StateSpace& second);

}  // namespace bodeflow::numerics
