#pragma once

#include <Eigen/Core>

namespace bodeflow::numerics {

/// The diagonal d of powers of two that makes rows and columns of diag(d)^-1 A diag(d) about equal in norm. The scaling itself is
/// exact. Method: Parlett & Reinsch, "Balancing a matrix for calculation of eigenvalues and eigenvectors", Numer. Math. 13, 1969,
/// without permutations. Entries must be finite. Cost: O(n^2) a sweep, few sweeps.
Eigen::VectorXd balancing_scales(const Eigen::MatrixXd& matrix);

/// diag(scales)^-1 matrix diag(scales).
Eigen::MatrixXd scaled_by(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& scales);

}  // namespace bodeflow::numerics
