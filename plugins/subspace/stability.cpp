#include "stability.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace bodeflow::subspace {
namespace {

constexpr double kOnCircle = 1e-14;

double factor_of(double magnitude, double margin) {
  if (magnitude > 2.0) return 0.0;
  return std::abs(magnitude - 1.0) <= kOnCircle ? 1.0 - margin : 2.0 / magnitude - 1.0;
}

}  // namespace

Expected<Projected> stable_projection(const Eigen::MatrixXd& A, double margin) {
  if (!A.allFinite()) return unexpected("the state matrix is not finite");
  Projected result{A, 0};
  if (A.rows() == 0) return result;
  const Eigen::RealSchur<Eigen::MatrixXd> schur(A);
  if (schur.info() != Eigen::Success) return unexpected("the Schur form of the state matrix was not found");
  Eigen::MatrixXd T = schur.matrixT();
  for (Eigen::Index k = 0; k < T.rows();) {
    const Eigen::Index size = k + 1 < T.rows() && T(k + 1, k) != 0.0 ? 2 : 1;
    const double magnitude =
        size == 1 ? std::abs(T(k, k)) : std::sqrt(std::abs(T(k, k) * T(k + 1, k + 1) - T(k, k + 1) * T(k + 1, k)));
    if (magnitude >= 1.0 - kOnCircle) {
      T.block(k, k, size, size) *= factor_of(magnitude, margin);
      result.moved += size;
    }
    k += size;
  }
  if (result.moved > 0) result.A = schur.matrixU() * T * schur.matrixU().transpose();
  return result;
}

}  // namespace bodeflow::subspace
