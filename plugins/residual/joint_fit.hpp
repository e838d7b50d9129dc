#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base_model.hpp"

namespace bodeflow::residual {

/// A base model with effects, their parameters joined in one vector: those of the base first.
struct JointModel {
  const BaseModel* base = nullptr;
  std::vector<const Effect*> effects;

  std::vector<Parameter> parameters() const;
  Extension extension(const Eigen::VectorXd& values) const;
  Eigen::VectorXcd steady_state(const Experiment& experiment, const Eigen::VectorXd& values) const;
};

/// Measured minus predicted lines in units of the noise's standard deviation: the real part at zero frequency, then real and
/// imaginary part of line 1, 2 ...; independent with unit variance where the model is right.
Eigen::VectorXd whitened(const Experiment& experiment, const Eigen::VectorXcd& predicted);
/// Where a line's values stand in it, and how many there are.
struct Rows {
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
};
inline Rows rows_of(Eigen::Index line) { return line == 0 ? Rows{0, 1} : Rows{2 * line - 1, 2}; }

/// A model fitted to some experiments.
struct Fit {
  JointModel model;
  Eigen::VectorXd values;
  Eigen::MatrixXd coordinate_covariance;  ///< of what the fit moves; of a parameter the data leave free, without its part
  Eigen::VectorXd std;                    ///< of `values`
  Eigen::MatrixXd covariance;             ///< of `values`
  double chi2 = 0.0;                      ///< over the experiments
  bool converged = false;
};

/// The maximum-likelihood fit to the experiments from that start which is nearest to the data: least squares of the whitened
/// residuals over all their lines, unexcited ones included, as the model predicts nothing there unless an effect makes it.
/// Errors: no start at which the model can be computed.
Expected<Fit> fit(const JointModel& model, std::span<const Experiment> experiments, const std::vector<Eigen::VectorXd>& starts);

/// The whitened residual of one experiment and its Jacobian by the coordinates.
struct Prediction {
  Eigen::VectorXcd lines;
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};
Prediction predict(const Fit& fit, const Experiment& experiment);

}  // namespace bodeflow::residual
