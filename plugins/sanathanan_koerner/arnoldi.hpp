#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>

namespace bodeflow::sanathanan_koerner {

/// Real polynomials q_0 .. q_M of z that are orthonormal over the lines: sum of w^2 Re(conj(q_i) q_j) = 1 for i = j, else 0. They
/// obey z q_j = sum over i <= j + 1 of h_ij q_i, q_0 = 1 / scale.
struct Basis {
  Eigen::MatrixXd vectors;     ///< w q_j at the lines, stacked (2 lines x M + 1): orthonormal columns
  Eigen::MatrixXd hessenberg;  ///< h, M + 1 x M
  double scale = 1.0;          ///< the norm of w

  Eigen::Index order() const { return hessenberg.cols(); }
};

/// The basis of polynomials up to the order, for points on the unit circle and weights w >= 0.
///
/// Method: Arnoldi's, classical Gram-Schmidt twice; neither powers of z nor their condition enter. Cost: O(lines * order^2).
/// Errors: weights that are zero or not finite; an order at which the points (those with a weight) are exhausted.
/// Source: P. D. Brubeck, Y. Nakatsukasa, L. N. Trefethen, Vandermonde with Arnoldi, SIAM Review 63, 2021,
/// doi:10.1137/19M130100X.
Expected<Basis> arnoldi(const Eigen::VectorXcd& z, const Eigen::VectorXd& weights, Eigen::Index order);

/// q_0 .. q_M at other points (points x M + 1), by the recurrence: right near the arc of the lines, where they do not grow.
Eigen::MatrixXcd polynomials_at(const Basis& basis, const Eigen::VectorXcd& z);

}  // namespace bodeflow::sanathanan_koerner
