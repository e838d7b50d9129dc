#pragma once

#include "trace/joint_fit.hpp"

namespace bodeflow::residual {

/// The fit whose parameters are told, with deviations that hold where the search's own are too small.
///
/// Where measured inputs drive a model that bends: what bends behind a noisy input looks rounder than it is. Likely inputs and
/// parameters are fitted in turn, the functional errors-in-variables model. The noise that the likely inputs still have is added
/// to them in pairs of draws of opposite sign, one Gauss-Newton step each; half of their difference is what it scatters the
/// parameters beside what a linear plant makes of it, which the covariance has already. Then the deviations of effects are
/// widened by profiles. Residual and Jacobian are those with the measured inputs.
Fit final_fit(const Fit& fit, const Measurements& records);

}  // namespace bodeflow::residual
