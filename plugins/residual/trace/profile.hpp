#pragma once

#include "trace/joint_fit.hpp"

namespace bodeflow::residual {

/// Widens the deviations of the parameters of effects to where the likelihood, with all others fitted anew, falls by as much as
/// at 1.96 deviations of a parabola: it falls more slowly where a law says little about a parameter on one side, and the
/// frequency of a tone has further peaks that noise raises.
///
/// Method: profile likelihood (D. M. Bates, D. G. Watts, Nonlinear Regression Analysis and Its Applications, 1988, chapter 6),
/// two Gauss-Newton steps of the others a point.
void widen_by_profiles(const FitProblem& problem, Fit& fit);

}  // namespace bodeflow::residual
