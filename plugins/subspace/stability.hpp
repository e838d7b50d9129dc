#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>

namespace bodeflow::subspace {

/// A matrix, and how many of its eigenvalues were moved into the unit disc.
struct Projected {
  Eigen::MatrixXd A;
  Eigen::Index moved = 0;
};

/// The matrix with its eigenvalues in the unit disc: those with 1 < |l| <= 2 go to l (2/|l| - 1), those beyond to 0, those on the
/// circle to (1 - margin) l. Method: step 8 of Akcay, Islam, Ninness in the real Schur form, whose 2 x 2 blocks are scaled as
/// they are: the complex form that the paper names does not give a real matrix back. Error: a Schur form that was not found.
Expected<Projected> stable_projection(const Eigen::MatrixXd& A, double margin = 1e-10);

}  // namespace bodeflow::subspace
