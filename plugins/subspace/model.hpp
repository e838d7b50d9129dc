#pragma once

#include <bodeflow/numerics/linear_system.hpp>

#include "range.hpp"

namespace bodeflow::subspace {

enum class Stability { none, project, maciejowski };

/// A state-space model, of s or z as the plane is, with what its making says.
struct Model {
  numerics::StateSpace system;
  Eigen::MatrixXcd response;      ///< at the lines, laid out as theirs
  Eigen::VectorXcd poles;         ///< in rad/s; of a discrete-time model as values of z
  Eigen::VectorXcd circle_poles;  ///< as values of the z of the plane
  Eigen::Index moved = 0;         ///< poles that were outside the unit disc and have been projected into it
  Eigen::Index unstable = 0;      ///< poles outside the unit disc that are left there

  Eigen::Index order() const { return system.states(); }
};

/// Steps 6 to 10 of Akcay, Islam, Ninness: the model of that order. A from the shift of the observability matrix,
///   C q_j(A) A = sum over i <= j + 1 of h_ij C q_i(A), j = 0 .. q - 2
/// (for powers: its own rows one block further), C from its first rows, B and D by weighted least squares on the response, one
/// triangular factor for all inputs.
///
/// Stability::project projects unstable poles (stability.hpp); Stability::maciejowski replaces A, where it is unstable, by the
/// least squares solution with zeros for the last block row: stable always, but it damps every lightly damped mode. Source:
/// J. M. Maciejowski, Guaranteed stability with subspace methods, Systems and Control Letters 26, 1995,
/// doi:10.1016/0167-6911(95)00010-7.
/// Errors: an order out of 1 .. (q - 1) outputs, or above the singular values there are; more unknowns of B and D than equations;
/// a pole at infinity; a fit that is not finite.
Expected<Model> model_of_order(const Lines& lines, const Plane& plane, const Range& range, Eigen::Index order,
                               Stability stability);

/// Maciejowski's state matrix of that order, in coordinates of the range's singular vectors.
Eigen::MatrixXd maciejowski_matrix(const Range& range, Eigen::Index order, Eigen::Index outputs);

/// The response of a system of s or z at these frequencies, laid out as that of Lines.
Eigen::MatrixXcd response_of(const numerics::StateSpace& system, const Eigen::VectorXd& omega_rad_s);

}  // namespace bodeflow::subspace
