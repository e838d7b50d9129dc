#include "trace/looks.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

constexpr numerics::LeastSquaresLimits kLimits{25, 1e-4};
constexpr double kStep = 1e-5;
// Positive parameters stay within a factor of e^9 of where they set out from: beyond it they say nothing any more.
constexpr double kFarthest = 9.0;

/// The coordinates that a fit moves beside those that are settled.
std::vector<Eigen::Index> own_coordinates(const FitProblem& problem) {
  std::vector<Eigen::Index> own;
  for (Eigen::Index i = 0; i < problem.layout().size(); ++i)
    if (!problem.is_settled(i)) own.push_back(i);
  return own;
}

/// Residuals by the looks with the settled coordinates eliminated.
class Eliminated {
 public:
  Eliminated(const FitProblem& problem, const Looks& looks, const Fit& before, const Eigen::VectorXd& point)
      : problem_(problem), looks_(looks), before_(before), point_(point), own_(own_coordinates(problem)) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(before.jacobian);
    q_ = qr.householderQ() * Eigen::MatrixXd::Identity(before.jacobian.rows(), before.jacobian.cols());
  }

  /// The search stays near that point.
  void set_out_from(const Eigen::VectorXd& point) { from_ = point; }
  Eigen::VectorXd start(const Eigen::VectorXd& point) const {
    Eigen::VectorXd c(static_cast<Eigen::Index>(own_.size()));
    for (std::size_t n = 0; n < own_.size(); ++n) c[static_cast<Eigen::Index>(n)] = point[own_[n]];
    return c;
  }
  Eigen::VectorXd whole(const Eigen::VectorXd& own) const {
    Eigen::VectorXd c = point_;
    for (std::size_t n = 0; n < own_.size(); ++n) c[own_[n]] = own[static_cast<Eigen::Index>(n)];
    return c;
  }
  Eigen::VectorXd residual(const Eigen::VectorXd& own) const {
    for (std::size_t n = 0; n < own_.size(); ++n)
      if (problem_.layout().is_logarithmic(own_[n]) && std::abs(own[static_cast<Eigen::Index>(n)] - from_[own_[n]]) > kFarthest)
        return Eigen::VectorXd::Constant(before_.residual.size(), std::numeric_limits<double>::quiet_NaN());
    return without_settled(before_.residual + looks_.change(whole(own)));
  }
  /// By differences: columns of the own coordinates, the settled ones not eliminated.
  Eigen::MatrixXd columns(const Eigen::VectorXd& own) const {
    const Eigen::VectorXd here = looks_.change(whole(own));
    Eigen::MatrixXd j(here.size(), own.size());
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      Eigen::VectorXd moved = own;
      moved[i] += kStep;
      j.col(i) = (looks_.change(whole(moved)) - here) / kStep;
    }
    return j;
  }
  Eigen::VectorXd without_settled(const Eigen::VectorXd& v) const { return v - q_ * (q_.transpose() * v); }

  numerics::LeastSquaresProblem problem() const {
    return {before_.residual.size(), [this](const Eigen::VectorXd& c, Eigen::VectorXd& r) { r = residual(c); },
            [this](const Eigen::VectorXd& c, Eigen::MatrixXd& j) {
              const Eigen::MatrixXd all = columns(c);
              j = all - q_ * (q_.transpose() * all);
            }};
  }

 private:
  const FitProblem& problem_;
  const Looks& looks_;
  const Fit& before_;
  Eigen::VectorXd point_, from_;
  std::vector<Eigen::Index> own_;
  Eigen::MatrixXd q_;
};

}  // namespace

std::optional<Looks> Looks::make(const FitProblem& problem, const Fit& before) {
  Looks all(problem);
  Eigen::Index begin = 0;
  for (std::size_t r = 0; r < problem.records().size(); ++r) {
    const Measurement& record = *problem.records()[r];
    auto look = record.open_loop(before.model, before.values(r), before.residual.segment(begin, record.rows()),
                                 problem.model().additions.back());
    if (!look) return {};
    all.looks_.push_back(std::move(look));
    begin += record.rows();
  }
  return all;
}

Eigen::VectorXd Looks::change(const Eigen::VectorXd& coordinates) const {
  Eigen::VectorXd all(problem_->rows());
  for (std::size_t r = 0; r < looks_.size(); ++r)
    all.segment(problem_->begin_of(r), problem_->records()[r]->rows()) =
        looks_[r]->change(problem_->model(), problem_->layout().values(coordinates, r));
  return all;
}

LookedUp look_up(const FitProblem& problem, const Looks& looks, const Fit& before, const std::vector<Eigen::VectorXd>& points) {
  LookedUp found;
  if (points.empty()) return found;
  Eliminated eliminated(problem, looks, before, points.front());
  const numerics::LeastSquaresProblem least_squares = eliminated.problem();
  Eigen::VectorXd best;
  double cost = eliminated.without_settled(before.residual).squaredNorm();
  for (const Eigen::VectorXd& point : points) {
    eliminated.set_out_from(point);
    const auto end = numerics::levenberg_marquardt(least_squares, eliminated.start(point), kLimits);
    if (!end || !end->parameters.allFinite() || !(end->cost < cost)) continue;
    best = end->parameters;
    cost = end->cost;
  }
  if (best.size() == 0) return found;
  found.promised = before.chi2 - cost;
  Approach a;
  a.at = eliminated.whole(best);
  a.residual = before.residual + looks.change(a.at);
  a.jacobian.resize(problem.rows(), a.at.size());
  const Eigen::MatrixXd own = eliminated.columns(best);
  Eigen::Index settled = 0, moved = 0;
  for (Eigen::Index i = 0; i < a.at.size(); ++i)
    a.jacobian.col(i) = problem.is_settled(i) ? before.jacobian.col(settled++) : own.col(moved++);
  if (!a.jacobian.allFinite()) return found;
  step_once(problem, a);
  found.approach = std::move(a);
  return found;
}

}  // namespace bodeflow::residual
