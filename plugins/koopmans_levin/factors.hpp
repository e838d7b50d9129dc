#pragma once

#include <Eigen/Core>

#include "lines.hpp"

namespace bodeflow::koopmans_levin {

/// All that a solution for any noise ratio needs of the data: triangular factors, small whatever the number of lines.
///
/// The equations A(z) Y - B(z) U - T(z) = 0, z = exp(-i w), A = 1 + a_1 z + .. + a_n z^n, B = b_0 + .. + b_n z^n,
/// T = tau_0 + .. + tau_(n-1) z^(n-1) (the transient: initial and final conditions), stand at each line as a row
///   [z^(n-1) .. 1 | Y z^n .. Y | U z^n .. U] [-tau; a; -b] = 0,
/// as real and imaginary parts, divided by the root of the total weight L. QR of all rows: [transient coupling; 0 data].
struct Factors {
  Eigen::Index order = 0;
  Eigen::MatrixXd transient;  ///< n x n upper triangular, empty without transient
  Eigen::MatrixXd coupling;   ///< n x q, q = 2n + 2
  Eigen::MatrixXd data;       ///< q x q upper triangular
  /// (n+1) x (n+1) upper triangular: noise^T noise = T_W, T_W(i,j) = 1/L sum_k cos((i-j) w_k), the covariance of
  /// [z^n Y~ .. Y~] for noise of unit variance; the identity for the full range.
  Eigen::MatrixXd noise;
  Eigen::Index equations = 0;        ///< real ones
  Eigen::Index free_parameters = 0;  ///< a_1 .. a_n, b_0 .. b_n and the transient

  bool has_transient() const { return transient.rows() > 0; }
};

/// The factors by blocked QR: rows are appended to the triangle in blocks, so memory does not grow with the lines. Right also
/// where the columns are nearly dependent (a narrow band, little noise). Cost: about 4 L (3n+2)^2 operations. Errors: an order
/// below 1 or above 64; fewer real equations than free parameters plus one.
Expected<Factors> factors(const Lines& lines, Eigen::Index order, bool transient = true);

/// The same for the full range from 4n+3 running sums: much faster where there are very many lines. The product of the data
/// matrix with itself loses half of the digits: solutions come out to about 1e-16 times the square of the condition number, which
/// is harmless for noisy data of the full range. Errors: those of `factors`; lines that are not the full range; a matrix that is
/// not positive definite in its digits.
Expected<Factors> factors_from_sums(const Lines& lines, Eigen::Index order, bool transient = true);

/// `factors`, by sums where the full range has more than 20,000 lines and these are well conditioned.
Expected<Factors> quick_factors(const Lines& lines, Eigen::Index order, bool transient = true);

/// Nothing, or why an order does not fit the number of equations.
Expected<void> check_order(Eigen::Index order, bool transient, Eigen::Index equations);

}  // namespace bodeflow::koopmans_levin
