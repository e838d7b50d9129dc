#pragma once

#include "functions.hpp"

namespace bodeflow::subspace {

/// What the data say of the range of the extended observability matrix: left singular vectors and singular values of R22.
struct Range {
  Rule rule;
  Eigen::VectorXd singular_values;  ///< falling
  Eigen::MatrixXd vectors;          ///< q outputs x as many as there are singular values
};

/// Data of more numbers than these (2 lines x q) are worked through in blocks.
inline constexpr Eigen::Index kLongData = 4'000'000;

/// Steps 2 to 5 of Akcay, Islam, Ninness: the rows q_j(z_k) G_k, without what the rows q_j(z_k) I explain, by orthogonal
/// factorisations alone. The conjugate half of step 2 is left out: with real and imaginary parts apart it repeats the first half.
///
/// functions: q, from 2 to most_functions. Cost: about 8 lines inputs (q outputs)^2 operations. Data longer than `long_data` are
/// worked through in blocks of lines (Basis::arnoldi alone), in memory for one block.
/// Errors: those of check; q out of range; lines that do not tell q functions apart.
/// Sources: H. Akcay, S. M. Islam, B. Ninness, Subspace based identification of power transformer models from frequency response
/// data, 1999; T. McKelvey, H. Akcay, L. Ljung, Subspace-based multivariable system identification from frequency response data,
/// IEEE Trans. Automatic Control 41, 1996, doi:10.1109/9.508900.
Expected<Range> range_of(const Lines& lines, const Plane& plane, Eigen::Index functions, Basis basis,
                         Eigen::Index long_data = kLongData);

}  // namespace bodeflow::subspace
