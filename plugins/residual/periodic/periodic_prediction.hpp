#pragma once

#include "periodic/periodic_record.hpp"

namespace bodeflow::residual {

/// What a model makes of a record's input in the steady state.
struct PeriodicPrediction {
  Eigen::VectorXcd bins;         ///< of the output, a bin of the record each; not finite outside of the domain
  Eigen::MatrixXd flow, stored;  ///< samples of a period x places, where `signals` were asked for
};

/// The steady state that the model predicts, tones left out.
///
/// Method: without a law the lines of the period in closed form (SampledPath); with one the period is simulated, or the whole
/// record where an effect depends on the time since it began. Maps of samples are run through one period before those that count.
/// An immittance beside a law acts as reactions that follow from the flow of the simulation before, until both agree (Anderson
/// mixing); where they do not, the result is not finite.
PeriodicPrediction predict(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values,
                           bool signals = false);

}  // namespace bodeflow::residual
