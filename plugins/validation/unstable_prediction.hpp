#pragma once

#include <Eigen/Core>

#include "simulation.hpp"

namespace bodeflow::validation {

/// What is predicted of the output of an unstable model.
struct UnstablePrediction {
  Eigen::VectorXd innovation;       ///< the one-step prediction error
  Eigen::VectorXd output;           ///< the prediction, `steps` samples ahead
  double innovation_std = 0.0;      ///< root mean square
  double expected_error_std = 0.0;  ///< of `steps` steps, for white innovations
};

/// The `steps`-step prediction of y by the model A y = B u + F e, where F is A with its roots outside the unit circle mirrored
/// into it: of all noise models with these poles the one whose output noise is white and whose predictor is stable. A constant
/// offset is taken off the innovations where asked for.
///
/// Method: e = (A y - B u) / F, error of the prediction: sum over i < steps of psi_i e[n-i], psi the impulse response of F / A.
/// Input and output have the samples that the simulation has, without those that the delay takes. Cost: O(samples (states +
/// steps)). Reference: U. Forssell, L. Ljung, IEEE Transactions on Automatic Control 45, 2000, doi:10.1109/9.827371.
UnstablePrediction predict_unstable(const numerics::StateSpace& system, const Eigen::VectorXd& input,
                                    const Eigen::VectorXd& output, Eigen::Index steps, bool offset);

}  // namespace bodeflow::validation
