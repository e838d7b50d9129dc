#pragma once

#include <Eigen/Core>

#include "records/model.hpp"
#include "records/response.hpp"

namespace bodeflow::validation {

/// How far a response is from the true one, relative to it.
struct ResponseError {
  Eigen::VectorXd relative;  ///< |G - G_0| / |G_0|, one a line
  double of_mean = 0.0;      ///< root mean square of these
  /// The same for one run, whose variance the response states: root mean square of (variance + |G - G_0|^2) / |G_0|^2; NaN
  /// without a variance.
  double of_one_run = 0.0;
};

/// The response of a model at frequencies [Hz]: numerator / denominator at s, or z = exp(s T) where the model is sampled, with
/// its delay.
Eigen::VectorXcd model_response(const records::ModelData& model, const Eigen::VectorXd& frequency_hz);

/// The error of a response of one input and output. Errors: more of them; a true response of 0 at a line; a line above half the
/// sample rate of the model.
Expected<ResponseError> response_error(const records::ResponseData& found, const records::ModelData& truth);

}  // namespace bodeflow::validation
