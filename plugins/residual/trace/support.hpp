#pragma once

#include <string>
#include <vector>

#include "trace/joint_fit.hpp"

namespace bodeflow::residual {

/// Why the fitted records hardly support an effect of a fitted model; "" if they do.
///
/// `amplitudes`: those of its parameters at which it vanishes. They have to stand off 0 with a probability `p` of chance: Wald's
/// statistic, by the covariance of the fit, and by that of a residual which is correlated within 40 blocks of the rows (W. K.
/// Newey, K. D. West, Econometrica 55 (1987) 703, for blocks); the smaller one counts. Left out where the fit has no Jacobian,
/// and for parameters that each record has for itself. No parameter may be beyond its bounds, and at a place no distance or
/// velocity greater than twice the largest of the records: they do not show what lies beyond.
std::string hardly_supported(const Fit& fit, std::size_t addition, const std::vector<Eigen::Index>& amplitudes, double p);

}  // namespace bodeflow::residual
