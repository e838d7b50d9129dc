#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>

#include "estimate.hpp"

namespace bodeflow::spectrum {

/// What one realisation tells at one line. The response is Y W and has the noise of (dY - G dU) W.
struct LineResponse {
  Eigen::MatrixXcd response;           ///< G, outputs x inputs
  Eigen::MatrixXcd weights;            ///< W, experiments x inputs
  Eigen::MatrixXd variance;            ///< of G; empty where noise is unknown
  Eigen::MatrixXd degrees_of_freedom;  ///< of it
  double condition = 1.0;              ///< of the inputs over the experiments
};

/// The mean spectra at line k: signals x experiments.
Eigen::MatrixXcd spectra_at(const Measured& measured, std::size_t realisation, Eigen::Index k);

/// The transfer from the references to all signals: Z R^H (R R^H)^-1, signals x references, and R^H (R R^H)^-1. Errors: as below.
struct FromReference {
  Eigen::MatrixXcd transfer;
  Eigen::MatrixXcd weights;
  double condition = 1.0;
};
Expected<FromReference> from_reference(const Measured& measured, std::size_t realisation, Eigen::Index k);

/// G, W and the variance of G at line k of one realisation; see estimate_response. Errors: inputs that the experiments do not
/// tell apart.
Expected<LineResponse> line_response(const Measured& measured, std::size_t realisation, Eigen::Index k, Form form);

/// Gives `at` variance and degrees of freedom from its response and weights.
void add_variance(LineResponse& at, const Measured& measured, std::size_t realisation, Eigen::Index k, Form form);

}  // namespace bodeflow::spectrum
