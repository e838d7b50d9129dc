#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <string>
#include <vector>

#include "data.hpp"
#include "partial_fractions.hpp"

namespace bodeflow::sanathanan_koerner {

/// How sure a model is.
struct Uncertainty {
  /// Of real and imaginary part, one a pole in the order of all_poles.
  std::vector<Eigen::Matrix2d> poles;
  /// Of poles and coefficients, where they are few; else empty. Order: real and imaginary part of each pair, real poles, then the
  /// coefficients channel by channel.
  Eigen::MatrixXd covariance;
};

/// The number of parameters beyond which `covariance` is left out: the square of it is kept.
inline constexpr Eigen::Index kMostParameters = 150;

/// The covariance of a model in partial fractions at a minimum of its error.
///
/// Method: inverse of J'J for the Jacobian J of the weighted residuals, residues eliminated where only the poles are wanted.
/// Assumes residuals that are independent from line to line and the truth within the model: what the model lacks is not in it.
/// variance: E|weight * (response - truth)|^2: 1 where the weights are those of a known variance.
/// Errors: poles that the data do not tell apart.
Expected<Uncertainty> uncertainty(const Data& data, const PartialFractions& model, double variance);

/// The real parameters of the model in the order of the covariance, with names such as "pole1_re", "residue1_im" and units.
struct FractionParameters {
  Eigen::VectorXd values;
  std::vector<std::string> names;
};
FractionParameters parameters_of(const PartialFractions& model);

}  // namespace bodeflow::sanathanan_koerner
