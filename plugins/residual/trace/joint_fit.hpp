#pragma once

#include <vector>

#include "trace/approach.hpp"

namespace bodeflow::residual {

/// A model fitted to some records together.
struct Fit {
  JointModel model;
  Coordinates layout;
  Eigen::VectorXd at;          ///< coordinates
  Eigen::MatrixXd covariance;  ///< of them; without its part for a combination the data leave free.
                               ///< Where a floor is unknown what is left counts as white noise.
  /// By how much deviations of coordinates are wider than `covariance` says, 1 or more: where the law differs from the plant's,
  /// what is left is more than noise at the rows that determine them.
  Eigen::VectorXd widening;
  Eigen::VectorXd residual;  ///< of the records below each other
  Eigen::MatrixXd jacobian;
  double chi2 = 0.0;
  bool converged = false;
  bool polished = false;  ///< an optimum; else where a quick search stands

  Eigen::VectorXd values(std::size_t record = 0) const { return layout.values(at, record); }
  /// Standard deviations of the values in that record.
  Eigen::VectorXd std(std::size_t record = 0) const;
  /// Covariance of the values of the shared parameters and those of the first record.
  Eigen::MatrixXd value_covariance() const;
};

/// The fit that a quick search has reached, its Jacobian as it stands.
Fit fit_at(const FitProblem& problem, const Approach& a);

/// The optimum near there. Method: Levenberg-Marquardt, derivatives by differences. Deviations are the larger of those of the
/// noise and of (J^T J)^-1 J^T diag(r^2) J (J^T J)^-1, which holds for models that are not quite right (H. White, Maximum
/// likelihood estimation of misspecified models, Econometrica 50 (1982) 1).
Expected<Fit> polish(const FitProblem& problem, const Eigen::VectorXd& coordinates);

/// The least-squares fit (maximum likelihood where the residuals are whitened noise) from the best of some starts, given as
/// values of the parameters: the two with the least cost are approached, the better one is polished. Errors: no start at which
/// the model can be computed.
Expected<Fit> fit(const JointModel& model, const Measurements& records, const std::vector<Eigen::VectorXd>& starts);

}  // namespace bodeflow::residual
