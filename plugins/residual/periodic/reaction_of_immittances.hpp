#pragma once

#include "model/sampled_path.hpp"
#include "model/simulate.hpp"

namespace bodeflow::residual {

/// A periodic simulation in which immittances take their part of the effort beside the laws: reactions w = Z(j omega) flow at
/// their places, found with the flow that they leave.
///
/// Method: fixed-point iteration over the period, simulation by simulation, with the last steps mixed so that the change becomes
/// least (D. G. Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12 (1965) 547). Errors: those of
/// simulate; no agreement within 40 simulations.
Expected<Simulated> simulate_with_immittances(const JointModel& model, const Eigen::VectorXd& values,
                                              std::span<const double> known, const SampledPath& path, Drive drive);

}  // namespace bodeflow::residual
