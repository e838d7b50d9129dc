#pragma once

#include "sampled/prediction.hpp"

namespace bodeflow::residual {

/// The state at the first sample of a stretch with which the prediction comes nearest to the measured output over it.
///
/// Method: Gauss-Newton from the answer of the base model to the state; derivatives by differences where the model is not linear
/// in its state; directions that the output hardly shows stay 0. Steps are halved while they do not lower the error. Cost:
/// (states
/// + 1) predictions a step, one step where the model is linear. `measured`: the output at the stretch's samples.
/// Errors: those of the prediction.
Expected<Eigen::VectorXd> initial_state(const Prediction& prediction, const Stretch& stretch, const Eigen::VectorXd& measured);

}  // namespace bodeflow::residual
