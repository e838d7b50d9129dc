#pragma once

#include <Eigen/Core>

#include "equations.hpp"

namespace bodeflow::maximum_likelihood {

/// Powers of x (rising, rows) of the whole denominator, fixed poles included, in its free coefficients (columns).
Eigen::MatrixXd denominator_powers(const Basis& basis, const Structure& structure, double scale);

/// An orthonormal basis of the theta in which every fixed coefficient has its value: theta = result * phi, a column for each free
/// direction, the common factor among them. Errors: fixed coefficients that contradict each other, or leave nothing free.
Expected<Eigen::MatrixXd> free_directions(const Bases& bases, const Structure& structure, double scale);

}  // namespace bodeflow::maximum_likelihood
