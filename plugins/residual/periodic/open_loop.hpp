#pragma once

#include <memory>

#include "periodic/periodic_record.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// The look at an effect of a periodic record beside `model`, which leaves `residual` (whitened rows) at `values`; nullptr for a
/// tone, a base model without a state space, and where no law has to be simulated.
///
/// Method: the motion at the place is that of the model, plus what a reaction there would move that makes what the model leaves
/// of the output: W = R / G_yw at the lines where R stands out of the noise, less the noise's share (N. Wiener). A law on this
/// motion gives a reaction, and the linear plant its output, folded at the sample rate; what other effects change follows in
/// closed form from the model's input and output. Laws that the model has already are left out of the paths. An effect that
/// depends on the time since the record began is run through the whole record, as if that repeated: the periods that are skipped
/// take up what the wrap leaves.
std::unique_ptr<const OpenLoop> periodic_open_loop(const PeriodicRecord& record, const JointModel& model,
                                                   const Eigen::VectorXd& values, const Eigen::VectorXd& residual,
                                                   const Addition& effect);

}  // namespace bodeflow::residual
