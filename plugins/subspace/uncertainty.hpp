#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <optional>

#include "model.hpp"
#include "sanathanan_koerner/uncertainty.hpp"

namespace bodeflow::subspace {

/// How sure a model is: poles with their covariances, and of a few parameters all of them.
struct ModelUncertainty {
  Eigen::VectorXcd poles;  ///< those of the model, conjugate pairs together
  sanathanan_koerner::Uncertainty of;
  std::optional<sanathanan_koerner::FractionParameters> parameters;  ///< what `of.covariance` is the covariance of
};

/// The covariance of a continuous-time model with simple poles, at a least-squares minimum: polish first.
///
/// Method: that of sanathanan_koerner/uncertainty.hpp, partial fractions with residues of every entry free. With several inputs
/// and outputs a state-space model has residues of rank 1 and fewer parameters: the deviations are then upper bounds.
/// known_variance: the weights are one over the deviation of the response; else the noise is taken from the residuals.
/// Errors: a model in z; poles that are not simple; as many parameters as the data have equations.
Expected<ModelUncertainty> uncertainty_of(const Lines& lines, const Model& model, bool known_variance);

}  // namespace bodeflow::subspace
