#include "search.hpp"

#include <Eigen/QR>
#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>

#include "coefficients.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

constexpr int kCharts = 4;
constexpr double kFar = 0.3;  // length of the step in the tangent, of a theta of length 1, from which on it is laid anew

// The estimate at parameters p = [t; change of the delay in units of 1/omega_highest].
Estimate moved(const Estimate& from, const Eigen::MatrixXd& directions, double delay_unit, const Eigen::VectorXd& p) {
  Estimate to = from;
  to.theta += directions * p.head(directions.cols());
  if (p.size() > directions.cols()) to.delay_s += delay_unit * p[p.size() - 1];
  return to;
}

}  // namespace

Expected<Eigen::MatrixXd> tangent(const Lines& lines, const Structure& structure, const Estimate& estimate) {
  const auto free = free_directions(estimate.bases, structure, lines.scale);
  if (!free) return refusal_in(free);
  const Eigen::MatrixXd phi = free->transpose() * estimate.theta;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(phi);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(phi.rows(), phi.rows());
  return Eigen::MatrixXd(*free * q.rightCols(phi.rows() - 1));
}

Expected<Minimum> search(const Lines& lines, const Structure& structure, const Estimate& start, double tolerance,
                         int evaluations) {
  Minimum minimum;
  minimum.estimate = start;
  const double highest = lines.omega_rad_s[lines.size() - 1], delay_unit = highest > 0.0 ? 1.0 / highest : 1.0;
  for (int chart = 0; chart < kCharts; ++chart) {
    minimum.estimate.theta.normalize();
    const Estimate from = minimum.estimate;
    const auto directions = tangent(lines, structure, from);
    if (!directions) return refusal_in(directions);
    numerics::LeastSquaresProblem problem;
    problem.residuals = 2 * lines.size() * static_cast<Eigen::Index>(lines.channels.size());
    problem.residual = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
      const Eigen::MatrixXcd found = residuals(lines, moved(from, *directions, delay_unit, p));
      r = stacked(found.reshaped());
    };
    problem.jacobian = [&](const Eigen::VectorXd& p, Eigen::MatrixXd& j) {
      const Eigen::MatrixXd all = stacked(jacobian(lines, moved(from, *directions, delay_unit, p)));
      j.leftCols(directions->cols()) = all.leftCols(all.cols() - 1) * *directions;
      if (structure.estimate_delay) j.col(j.cols() - 1) = delay_unit * all.col(all.cols() - 1);
    };
    const Eigen::VectorXd origin = Eigen::VectorXd::Zero(directions->cols() + (structure.estimate_delay ? 1 : 0));
    const auto fit = numerics::levenberg_marquardt(problem, origin, {evaluations, tolerance});
    if (!fit) return refusal_in(fit);
    minimum.estimate = moved(from, *directions, delay_unit, fit->parameters);
    minimum.cost = fit->cost;
    minimum.converged = fit->converged;
    minimum.reason = fit->reason;
    if (fit->parameters.head(directions->cols()).norm() < kFar) break;
  }
  return minimum;
}

}  // namespace bodeflow::maximum_likelihood
