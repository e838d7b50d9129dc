#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trace/approach.hpp"
#include "trace/joint_fit.hpp"

namespace bodeflow::residual {

/// The looks (OpenLoop) of all fitted records at the effect that a problem's model has beside those of a fit. Refers to both.
class Looks {
 public:
  /// Nothing where a record has no such look.
  static std::optional<Looks> make(const FitProblem& problem, const Fit& before);

  /// What the effect changes in the residual of all records below each other, at these coordinates of the problem.
  Eigen::VectorXd change(const Eigen::VectorXd& coordinates) const;

 private:
  explicit Looks(const FitProblem& problem) : problem_(&problem) {}
  const FitProblem* problem_;
  std::vector<std::unique_ptr<const OpenLoop>> looks_;
};

/// Where a search by looks ended.
struct LookedUp {
  Approach approach;      ///< with the residual of the model itself; not started where that can't be computed
  double promised = 0.0;  ///< fall of the cost by the looks
};

/// The best values of the effect's parameters by the looks, from some points (coordinates), and the model there.
///
/// Method: the coordinates that were settled follow linearly and are eliminated (G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10
/// (1973) 413); the effect's own are found by Levenberg-Marquardt. The model is computed once, after a Gauss-Newton step of all.
LookedUp look_up(const FitProblem& problem, const Looks& looks, const Fit& before, const std::vector<Eigen::VectorXd>& points);

}  // namespace bodeflow::residual
