#pragma once

#include <span>

#include "joint_fit.hpp"
#include "records/model.hpp"

namespace bodeflow::residual {

/// The model of a fit as a record says it: parameters of the base and of the effects with covariance, numerator and denominator
/// of the linear part. A warning names effects that these polynomials leave out.
records::ModelData model_of(const Fit& fit, std::span<const Experiment> experiments);

}  // namespace bodeflow::residual
