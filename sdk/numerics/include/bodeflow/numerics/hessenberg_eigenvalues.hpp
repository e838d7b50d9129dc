#pragma once

#include <Eigen/Core>

#include "bodeflow/numerics/error.hpp"

namespace bodeflow::numerics {

/// The eigenvalues of a real matrix that is zero below its first subdiagonal, conjugate pairs one after the other.
///
/// Method: Francis's double shifts on the part that has not come apart yet; no vectors, so the rest is left alone: half the work
/// of a Schur form. Cost: about 6 n^3 operations. What stands below the subdiagonal is not looked at. Errors: entries that are
/// not finite; an eigenvalue that is not found in 60 steps. Source: J. G. F. Francis, The QR transformation, part 2, Computer
/// Journal 4, 1962, doi:10.1093/comjnl/4.4.332.
Expected<Eigen::VectorXcd> hessenberg_eigenvalues(Eigen::MatrixXd H);

/// Those of any real square matrix.
Expected<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& A);

}  // namespace bodeflow::numerics
