#pragma once

#include "lines.hpp"

namespace bodeflow::subspace {

/// How far a model is from data.
struct Quality {
  double maximum = 0.0;   ///< (4): the largest error of a line, Frobenius norm over its entries
  double rms = 0.0;       ///< (5): root of the mean square of the lines' errors
  double relative = 0.0;  ///< root of the sum of squares of the errors over that of the data
  double weighted = 0.0;  ///< `relative`, with the lines' weights in both sums
};

/// The measures (4) and (5) of Akcay, Islam, Ninness, and relative ones. `response` is laid out as that of the lines.
Quality quality_of(const Lines& lines, const Eigen::MatrixXcd& response);

}  // namespace bodeflow::subspace
