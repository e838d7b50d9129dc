#include "trace/approach.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-9;
constexpr double kRaisedDamping = 1e-4;
constexpr int kTrials = 5;
// A step that gains less than this part of what all have gained is the last.
constexpr double kLittle = 0.005;

// A coordinate that says next to nothing must not be sent away by rounding: a factor of e^4 a step, or 1000 typical sizes.
constexpr double kFarthestFactor = 4.0, kFarthestSizes = 1e3;

/// A damped Gauss-Newton step, solved in columns of unit length.
Eigen::VectorXd step_of(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual, double damping) {
  const Eigen::VectorXd scale = jacobian.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  Eigen::MatrixXd normal = scale.asDiagonal() * (jacobian.transpose() * jacobian) * scale.asDiagonal();
  normal.diagonal().array() += damping;
  const Eigen::VectorXd gradient = scale.asDiagonal() * (jacobian.transpose() * residual);
  return -(scale.asDiagonal() * normal.ldlt().solve(gradient));
}

Eigen::VectorXd limited(const FitProblem& problem, Eigen::VectorXd step) {
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const double most = problem.layout().is_logarithmic(i) ? kFarthestFactor : kFarthestSizes;
    step[i] = std::clamp(step[i], -most, most);
  }
  return step;
}

/// The step within the bounds of the base: coordinates that it would take out go to their bound, and the others make the best of
/// it.
Eigen::VectorXd bounded_step(const FitProblem& problem, const Approach& a, double damping) {
  Eigen::VectorXd step = limited(problem, step_of(a.jacobian, a.residual, damping));
  const Eigen::VectorXd allowed = problem.within_bounds(a.at + step) - a.at;
  const Eigen::Array<bool, Eigen::Dynamic, 1> cut = (problem.within_bounds(a.at + step) - (a.at + step)).array().abs() > 0.0;
  if (!cut.any()) return step;
  Eigen::MatrixXd jacobian = a.jacobian;
  Eigen::VectorXd residual = a.residual;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    if (!cut[i]) continue;
    residual += jacobian.col(i) * allowed[i];
    jacobian.col(i).setZero();
  }
  step = limited(problem, step_of(jacobian, residual, damping));
  for (Eigen::Index i = 0; i < step.size(); ++i)
    if (cut[i]) step[i] = allowed[i];
  return problem.within_bounds(a.at + step) - a.at;
}

void refresh(const FitProblem& problem, bool all, Approach& a) {
  for (Eigen::Index i = 0; i < a.at.size(); ++i) {
    if (!all && problem.is_settled(i)) continue;
    const Eigen::VectorXd column = problem.column(i, a.at, a.residual);
    if (column.allFinite()) a.jacobian.col(i) = column;
  }
}

/// Makes the Jacobian explain the step that was taken.
void update(const Eigen::VectorXd& step, const Eigen::VectorXd& change, Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd weight = jacobian.colwise().squaredNorm().transpose().cwiseProduct(step);
  const double length = weight.dot(step);
  if (!(length > 0.0)) return;
  jacobian += (change - jacobian * step) * (weight / length).transpose();
}

}  // namespace

Approach approach_from(const FitProblem& problem, const Eigen::VectorXd& start, const Eigen::MatrixXd& settled_columns) {
  Approach a;
  a.at = start;
  a.residual = problem.residual(start);
  if (!a.residual.allFinite()) return a;
  a.cost = a.residual.squaredNorm();
  a.jacobian = Eigen::MatrixXd::Zero(problem.rows(), start.size());
  Eigen::Index from = 0;
  for (Eigen::Index i = 0; i < start.size() && from < settled_columns.cols(); ++i)
    if (problem.is_settled(i)) a.jacobian.col(i) = settled_columns.col(from++);
  refresh(problem, settled_columns.cols() == 0, a);
  a.started = true;
  return a;
}

double promised_cost(const Approach& a) {
  const Eigen::VectorXd step = step_of(a.jacobian, a.residual, kLeastDamping);
  return step.allFinite() ? (a.residual + a.jacobian * step).squaredNorm() : a.cost;
}

void step_once(const FitProblem& problem, Approach& a) {
  const Eigen::VectorXd step = bounded_step(problem, a, kLeastDamping);
  a.at += step;
  a.residual = problem.residual(a.at);
  a.cost = a.residual.squaredNorm();
  a.started = step.allFinite() && a.residual.allFinite();
}

void approach(const FitProblem& problem, int steps, double least_fall, bool thorough, Approach& a) {
  if (!a.started) return;
  const double start = a.cost;
  double damping = kFirstDamping;
  bool fresh = false;
  for (int n = 0; n < steps; ++n) {
    const double before = a.cost;
    for (int trial = 0; trial < kTrials && a.cost == before; ++trial) {
      const Eigen::VectorXd step = bounded_step(problem, a, damping);
      const Eigen::VectorXd next = a.at + step;
      const Eigen::VectorXd residual = problem.residual(next);
      const double cost = residual.allFinite() ? residual.squaredNorm() : std::numeric_limits<double>::infinity();
      if (!(cost < a.cost)) {
        damping = std::max(damping, kRaisedDamping) * 10.0;
        continue;
      }
      update(step, residual - a.residual, a.jacobian);
      a.at = next;
      a.residual = residual;
      a.cost = cost;
      damping = std::max(damping / 10.0, kLeastDamping);
    }
    const bool small = before - a.cost < std::max(least_fall, kLittle * (start - a.cost));
    if (small && (fresh || !thorough)) return;
    fresh = small;
    if (n + 1 < steps) refresh(problem, small, a);
    if (small) damping = kFirstDamping;
  }
}

}  // namespace bodeflow::residual
