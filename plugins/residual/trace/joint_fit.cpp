#include "trace/joint_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>
#include <numeric>

#include "model/plant_matrices.hpp"

namespace bodeflow::residual {
namespace {

constexpr numerics::LeastSquaresLimits kLimits{40, 1e-6};
constexpr std::size_t kStarts = 2;
constexpr int kSteps = 12;

Eigen::VectorXd widening(const Fit& f) {
  const Eigen::MatrixXd normal = pseudo_inverse_normal(f.jacobian);
  const Eigen::MatrixXd by_row = (f.jacobian * normal).cwiseAbs2();
  const Eigen::VectorXd misfit = by_row.transpose() * f.residual.cwiseAbs2(), noise = f.covariance.diagonal();
  Eigen::VectorXd wider = Eigen::VectorXd::Ones(noise.size());
  for (Eigen::Index i = 0; i < noise.size(); ++i)
    if (noise[i] > 0.0) wider[i] = std::sqrt(std::max(misfit[i] / noise[i], 1.0));
  return wider;
}

/// Whether the base model has a pole at 0; told without what records state.
bool integrates(const JointModel& model, const Eigen::VectorXd& values) {
  if (!model.base->has_state_space() || !model.base->known().empty()) return false;
  const auto plant = plant_matrices(*model.base, values.data(), {});
  if (!plant || plant->states() == 0) return false;
  const Eigen::VectorXd sizes = plant->A.eigenvalues().cwiseAbs();
  return sizes.minCoeff() <= 1e-12 * sizes.maxCoeff();
}

}  // namespace

Eigen::VectorXd Fit::std(std::size_t record) const {
  const Eigen::VectorXd slopes = layout.slopes(values(record));
  Eigen::VectorXd s(slopes.size());
  for (Eigen::Index p = 0; p < s.size(); ++p) {
    const Eigen::Index i = layout.index(static_cast<std::size_t>(p), record);
    s[p] = std::abs(slopes[p]) * widening[i] * std::sqrt(std::max(covariance(i, i), 0.0));
  }
  return s;
}

Eigen::MatrixXd Fit::value_covariance() const {
  const Eigen::VectorXd slopes = layout.slopes(values());
  Eigen::MatrixXd c(slopes.size(), slopes.size());
  for (Eigen::Index p = 0; p < c.rows(); ++p)
    for (Eigen::Index q = 0; q < c.cols(); ++q) {
      const Eigen::Index i = layout.index(static_cast<std::size_t>(p), 0), j = layout.index(static_cast<std::size_t>(q), 0);
      c(p, q) = slopes[p] * slopes[q] * widening[i] * widening[j] * covariance(i, j);
    }
  return c;
}

Fit fit_at(const FitProblem& problem, const Approach& a) {
  Fit f;
  f.model = problem.model();
  f.layout = problem.layout();
  f.at = a.at;
  f.residual = a.residual;
  f.jacobian = a.jacobian;
  f.covariance = pseudo_inverse_normal(a.jacobian);
  f.widening = Eigen::VectorXd::Ones(a.at.size());
  f.chi2 = a.cost;
  const auto known = [](const auto& r) { return r->floor_known(); };
  if (!std::all_of(problem.records().begin(), problem.records().end(), known))
    f.covariance *= a.cost / std::max(static_cast<double>(a.residual.size() - a.at.size()), 1.0);
  return f;
}

Expected<Fit> polish(const FitProblem& problem, const Eigen::VectorXd& coordinates) {
  // The search ends where steps are small beside the coordinates: they are counted from a unit before the start.
  const Eigen::VectorXd origin = coordinates - Eigen::VectorXd::Ones(coordinates.size());
  Eigen::VectorXd point, there;  // the last residual, which the Jacobian at the same point needs again
  const auto residual = [&](const Eigen::VectorXd& c) {
    if (point.size() == 0 || point != c) {
      there = problem.residual(origin + c);
      point = c;
    }
    return there;
  };
  const numerics::LeastSquaresProblem least_squares{problem.rows(),
                                                    [&](const Eigen::VectorXd& c, Eigen::VectorXd& r) { r = residual(c); },
                                                    [&](const Eigen::VectorXd& c, Eigen::MatrixXd& j) {
                                                      const Eigen::VectorXd here = residual(c);
                                                      j = problem.jacobian(origin + c, here);
                                                    }};
  const auto found = numerics::levenberg_marquardt(least_squares, coordinates - origin, kLimits);
  if (!found) return tl::unexpected(found.error());
  const Eigen::VectorXd at = origin + found->parameters;
  Approach end{problem.within_bounds(at), found->residual, found->jacobian, found->cost, true};
  if (end.at != at) end.jacobian = problem.jacobian(end.at, end.residual);
  if (!end.jacobian.allFinite() || !end.residual.allFinite()) return refused("the search ended at the border of the domain");
  Fit f = fit_at(problem, end);
  f.widening = widening(f);
  f.converged = found->converged;
  f.polished = true;
  return f;
}

Expected<Fit> fit(const JointModel& model, const Measurements& records, const std::vector<Eigen::VectorXd>& starts) {
  FitProblem problem(model, records);
  std::vector<Eigen::VectorXd> points;
  std::vector<double> costs;
  for (const Eigen::VectorXd& start : starts) {
    points.push_back(problem.layout().of(start));
    const double cost = problem.residual(points.back()).squaredNorm();
    costs.push_back(std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity());
  }
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  Approach best;
  for (std::size_t n = 0; n < std::min(order.size(), kStarts); ++n) {
    if (!std::isfinite(costs[order[n]])) break;
    problem.bound_base(points[order[n]]);
    Approach a = approach_from(problem, points[order[n]], Eigen::MatrixXd());
    if (order.size() > 1) approach(problem, kSteps, 1e-4 * a.cost, true, a);
    if (a.started && (!best.started || a.cost < best.cost)) best = std::move(a);
  }
  if (!best.started) {
    const bool drifts = !starts.empty() && integrates(model, starts.front());
    return refused(std::string("the model can't be computed at any of the parameters to start from") +
                   (drifts
                        ? ": it has a state that integrates (a pole at 0), which has no steady state over a period; leave that "
                          "state out where no effect needs it"
                        : ""));
  }
  problem.bound_base(points[order.front()]);
  return polish(problem, best.at);
}

}  // namespace bodeflow::residual
