#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <vector>

#include "fit.hpp"

namespace bodeflow::sanathanan_koerner {

/// One iterate of the paper's method: d = 1 + d_1 z^-1 + .. + d_M z^-M and the numerators refitted for it.
struct MonomialIterate {
  Eigen::VectorXd denominator;  ///< 1, d_1 .. d_M
  Eigen::MatrixXd numerators;   ///< n_0 .. n_M of each channel, M + 1 x channels
  double error = 0.0;           ///< weighted residual over the weighted data
  Eigen::Index unstable = 0;    ///< roots outside the unit circle
};

/// The iterates of D. A. Jue's method as printed: powers of z^-1, a leading coefficient of 1, weight 1/|d|^e of the iterate
/// before (1 first), columns scaled, least squares by QR; nothing is reflected. Its condition grows with the order and the width
/// of the range: it is here to be compared with, `fit` is what to use.
///
/// stop: rule for the iteration. Errors: those of check, check_order.
/// Source: D. A. Jue, 1998, sections 2.2 and 2.4.1; 1/sqrt|d|: section 2.2.3. Its map is the inverse of ours, see plane.hpp.
Expected<std::vector<MonomialIterate>> monomial_iterates(const Data& data, const Plane& plane, const FitSettings& settings);

/// The best stable iterate as a model, as the paper keeps it: estimates that are unstable are discarded; with settings.stable
/// false the best of all. Errors: as monomial_iterates; no iterate is stable.
Expected<Fit> monomial_fit(const Data& data, const Plane& plane, const FitSettings& settings);

}  // namespace bodeflow::sanathanan_koerner
