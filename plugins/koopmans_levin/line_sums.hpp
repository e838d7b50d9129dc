#pragma once

#include <Eigen/Core>

#include "lines.hpp"

namespace bodeflow::koopmans_levin {

/// Weighted means over the lines, m = 0 .. order: mean of |Y|^2 cos(m w), |U|^2 cos(m w), cos(m w), and Re(conj(Y) U z^m),
/// Re(Y z^m), Re(U z^m) for m = -order .. order (index m + order).
struct LineSums {
  Eigen::Index order = 0;
  Eigen::VectorXd yy, uu, one;
  Eigen::VectorXd yu, y, u;

  /// Sigma = 1/L Re(Phi^H Phi) with the columns [z^(n-1) .. 1 | Y z^n .. Y | U z^n .. U]: every entry is one of the sums, since
  /// conj(P z^i) Q z^j = conj(P) Q z^(j-i).
  Eigen::MatrixXd normal_matrix(bool transient) const;
};

/// The sums in one pass. The powers of z come from angle addition against a table of one block and a three-term recurrence in m,
/// so no error grows along the lines. Cost: about 16n + 20 operations a line.
LineSums line_sums(const Lines& lines, Eigen::Index order);

}  // namespace bodeflow::koopmans_levin
