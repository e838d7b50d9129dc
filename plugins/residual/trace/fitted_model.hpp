#pragma once

#include "records/model.hpp"
#include "trace/trace.hpp"

namespace bodeflow::residual {

/// The fitted model as a record `model` of form `physical`: parameters with covariance; numerator and denominator of the base's
/// small-signal part where it has one input and a state space of at most 12 states.
records::ModelData model_of(const Fit& fit, const Measurements& records);

}  // namespace bodeflow::residual
