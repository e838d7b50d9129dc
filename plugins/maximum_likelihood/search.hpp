#pragma once

#include <string>

#include "equations.hpp"

namespace bodeflow::maximum_likelihood {

/// A local minimum of the cost.
struct Minimum {
  Estimate estimate;
  double cost = 0.0;
  bool converged = false;
  std::string reason;  ///< why the search ended
};

/// The directions in which a model can change: columns in theta, the common factor of A and B left out.
Expected<Eigen::MatrixXd> tangent(const Lines& lines, const Structure& structure, const Estimate& estimate);

/// A local minimum from `start`. Levenberg-Marquardt with exact derivatives in the tangent at the start, which is laid anew where
/// the search has gone far from it. tolerance: see numerics::LeastSquaresLimits.
/// Errors: those of levenberg_marquardt and free_directions.
Expected<Minimum> search(const Lines& lines, const Structure& structure, const Estimate& start, double tolerance,
                         int evaluations);

}  // namespace bodeflow::maximum_likelihood
