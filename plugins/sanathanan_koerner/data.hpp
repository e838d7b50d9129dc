#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <vector>

namespace bodeflow::sanathanan_koerner {

/// A frequency response that is fitted: lines in rows, channels in columns. A matrix of responses is stacked column by column:
/// channel input * outputs + output.
struct Data {
  Eigen::VectorXd omega_rad_s;  ///< rises
  Eigen::MatrixXcd response;
  Eigen::MatrixXd weights;  ///< of the residuals, not below 0; one column for all channels, or one a channel

  Eigen::Index lines() const { return omega_rad_s.size(); }
  Eigen::Index channels() const { return response.cols(); }
  bool common_weights() const { return weights.cols() == 1; }
  auto weights_of(Eigen::Index channel) const { return weights.col(common_weights() ? 0 : channel); }
};

/// Nothing. Errors, by name: no lines, sizes that do not fit, values that are not finite, frequencies below 0 or that do not
/// rise, a response that is zero everywhere, weights below 0 or zero everywhere.
Expected<void> check(const Data& data);

/// Nothing. Errors: fewer lines with a weight than a model of that order needs.
Expected<void> check_order(const Data& data, Eigen::Index order);

/// The residual where the model is zero: the root of the sum of |weight * response|^2.
double weighted_norm(const Data& data);

/// Lines x channels of weight * (response - model).
Eigen::MatrixXcd weighted_residual(const Data& data, const Eigen::MatrixXcd& model);

/// The lines of those numbers alone.
Data lines_of(const Data& data, const std::vector<Eigen::Index>& rows);

}  // namespace bodeflow::sanathanan_koerner
