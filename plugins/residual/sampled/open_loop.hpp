#pragma once

#include <memory>

#include "sampled/record_residual.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// The look at a law of a record over time beside `model` at `values`, for residuals in units of `unit`; nullptr for other
/// effects, and for plants without states, whose residual is as quick.
///
/// Method: the motion at the place is that of the model, plus what a reaction there would move that makes what the model leaves
/// of the output: in each stretch that is simulated from a state of its own, at the lines of its mirrored spectrum where the rest
/// stands out of the innovations of its noise model, less their share (N. Wiener). A law on this motion gives a reaction,
/// straight between its values, and the linear plant its output exactly; what another initial state can make of that is taken
/// off, as the residual does. Laws and maps that the model has already are left out of that path.
std::unique_ptr<const OpenLoop> sampled_open_loop(const SampledRecord& record, const JointModel& model,
                                                  const Eigen::VectorXd& values, const Addition& effect, double unit);

}  // namespace bodeflow::residual
