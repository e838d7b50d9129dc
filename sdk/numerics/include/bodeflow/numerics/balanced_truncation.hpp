#pragma once

#include <Eigen/Core>

#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {

/// A real L with A P + P A' + B B' = 0, P = L L', for a stable A: the factor itself, so that small singular values of P keep
/// digits that P in doubles can't hold. Method: Hammarling, "Numerical solution of the stable, non-negative definite Lyapunov
/// equation", IMA J. Numer. Anal. 2, 1982, on the complex Schur form; its complex factor F becomes the real one by
/// P = [re F, im F] [re F, im F]'. Cost: O(n^3). Errors: A not square or B of another height, values that are not finite, an
/// eigenvalue that is not left of the imaginary axis.
Expected<Eigen::MatrixXd> gramian_factor(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The Hankel singular values in falling order, exact to about the rounding error of the largest one (not to its square root).
/// A discrete-time system is mapped to a continuous one first, which leaves them as they are. Errors: an unstable system.
Expected<Eigen::VectorXd> hankel_singular_values(const StateSpace& system);

/// A reduced system, and what its reduction left out.
struct Reduced {
  StateSpace system;
  Eigen::VectorXd hankel_singular_values;  ///< of the given system
  double error_bound = 0.0;                ///< 2 x the sum of those left out bounds the largest error over frequency
};

/// The balanced truncation to `states` states: those with the largest Hankel singular values, in balanced coordinates.
/// Method: square root method (Laub, Heath, Paige, Ward, "Computation of system balancing transformations", IEEE Trans. Autom.
/// Control 32, 1987) with `gramian_factor`; discrete-time systems by way of the bilinear map. D of a continuous system is kept.
/// Errors: an unstable system, more states than it has, more than the Hankel singular values above rounding.
Expected<Reduced> balanced_truncation(const StateSpace& system, Eigen::Index states);

}  // namespace bodeflow::numerics
