#pragma once

#include <Eigen/Core>
#include <complex>

#include "expected.hpp"

namespace bodeflow::maximum_likelihood {

/// Real polynomials q_0 .. q_n with sum_k w_k^2 Re(conj(q_i(x_k)) q_j(x_k)) = [i = j], q_j of degree j. Powers of s over three
/// decades are useless from order 5 on; in these every order to 20 and more can be solved for.
///
/// Method: the Arnoldi process on multiplication by x, each vector orthogonalised twice: x q_j = sum_{i <= j+1} H_ij q_i (P. D.
/// Brubeck, Y. Nakatsukasa, L. N. Trefethen, "Vandermonde with Arnoldi", SIAM Review 63, 2021, doi:10.1137/19M130100X). Cost:
/// O(lines n^2).
class Basis {
 public:
  /// Errors: lines that do not tell polynomials of this degree apart (too few of them, or without weight).
  static Expected<Basis> orthonormal(const Eigen::VectorXcd& points, const Eigen::VectorXd& weights, Eigen::Index degree);

  Eigen::Index degree() const { return recurrence_.cols(); }
  Eigen::Index size() const { return degree() + 1; }
  /// q_j(x_k), lines x (n + 1).
  const Eigen::MatrixXcd& values() const { return values_; }
  /// q_0 .. q_n at any x.
  Eigen::VectorXcd at(std::complex<double> x) const;
  /// Powers of x (rising, rows) in each q_j (columns); upper triangular.
  Eigen::MatrixXd monomials() const;
  /// Coefficients c with sum_j c_j q_j(x_k) = values_k, for values that are those of such a polynomial.
  Eigen::VectorXd coefficients(const Eigen::VectorXcd& values) const;
  /// Roots of sum_j c_j q_j, in conjugate pairs, by magnitude: the eigenvalues of H with a last column changed by c. Fewer than n
  /// where the last coefficients are 0.
  Eigen::VectorXcd roots(const Eigen::VectorXd& c) const;

 private:
  Eigen::MatrixXcd values_;
  Eigen::MatrixXd recurrence_;  // H, (n + 1) x n
  Eigen::VectorXd weights_;
  double first_ = 1.0;  // q_0
};

}  // namespace bodeflow::maximum_likelihood
