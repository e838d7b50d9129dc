#pragma once

#include "trace/fit_problem.hpp"

namespace bodeflow::residual {

/// Where a quick search stands.
struct Approach {
  Eigen::VectorXd at;        ///< coordinates
  Eigen::VectorXd residual;  ///< there
  Eigen::MatrixXd jacobian;  ///< about there: settled columns may be of points passed before
  double cost = 0.0;         ///< |residual|^2
  bool started = false;      ///< the model can be computed at the start
};

/// The start with a Jacobian: the columns of settled coordinates are those given, of a point nearby, the others are formed
/// afresh; all are where none is given.
Approach approach_from(const FitProblem& problem, const Eigen::VectorXd& start, const Eigen::MatrixXd& settled_columns);

/// The cost that a Gauss-Newton step from there would reach if the problem were linear.
double promised_cost(const Approach& a);

/// Moves by one Gauss-Newton step within the bounds; `started` is whether the model can be computed there.
void step_once(const FitProblem& problem, Approach& a);

/// Goes on for at most that many steps, or until one lowers the cost by less than `least_fall`, or by less than a part in 200 of
/// what all have. Where `thorough`, all columns are then formed afresh once and it goes on.
///
/// Method: Levenberg-Marquardt on the normal equations; settled columns follow by Broyden's rank-one update (C. G. Broyden, A
/// class of methods for solving nonlinear simultaneous equations, Math. Comp. 19 (1965) 577), the others are formed afresh each
/// step. A step so costs one residual a parameter that is not settled. The Jacobian is not exact at the end: for a covariance
/// polish the result.
void approach(const FitProblem& problem, int steps, double least_fall, bool thorough, Approach& a);

}  // namespace bodeflow::residual
