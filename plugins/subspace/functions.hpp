#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>

#include "lines.hpp"

namespace bodeflow::subspace {

enum class Basis { arnoldi, powers };

/// The rule of basis functions q_0 .. q_{q-1} of z, real polynomials of rising degree: z q_j = sum over i <= j + 1 of h_ij q_i.
struct Rule {
  Eigen::MatrixXd shift;  ///< h, q x (q - 1)
  double first = 1.0;     ///< q_0, a constant
};

/// Basis functions at the lines, times the lines' weights over the root of their number, stacked (real parts above imaginary
/// ones: 2 lines x q).
struct Functions {
  Rule rule;
  Eigen::MatrixXd values;
  Eigen::MatrixXd orthonormal;  ///< of the same span; empty: `values` themselves are
};

/// All at once. Basis::powers are those of Akcay's equations, z^j, ill-conditioned on a narrow band; Basis::arnoldi is
/// orthonormal over the lines. Cost: O(lines * q^2), memory 2 lines x q numbers. Errors: more functions than the lines can tell
/// apart.
Expected<Functions> functions_of(const Lines& lines, const Plane& plane, Eigen::Index count, Basis basis);

/// Functions that are orthonormal over the lines, one block of lines after the other: for data too long to hold them all.
///
/// Method: Szego's recurrence with reversed polynomials,
///   rho_j q_{j+1} = z q_j - alpha_j q*_j,   q*_{j+1} = rho_j q*_j - alpha_j q_{j+1},   alpha_j = <q*_j, z q_j>,
/// whose coefficients need two vectors of the lines' length. Without a second orthogonalisation: `defect` says how far from
/// orthonormal they are. Source: U. Grenander, G. Szego, Toeplitz Forms and Their Applications, 1958, chapter 2.
class LongFunctions {
 public:
  /// Errors: more functions than the lines can tell apart.
  static Expected<LongFunctions> make(const Lines& lines, const Plane& plane, Eigen::Index count);

  const Rule& rule() const { return rule_; }
  /// Those of some lines, stacked.
  Eigen::MatrixXd block(Eigen::Index first, Eigen::Index size) const;
  /// An estimate of the largest entry of V'V - I, from columns of signs.
  double defect(Eigen::Index block_size) const;

 private:
  Eigen::VectorXcd z_;
  Eigen::VectorXd weight_;  ///< with norm 1
  Eigen::VectorXd alpha_;
  Rule rule_;
};

}  // namespace bodeflow::subspace
