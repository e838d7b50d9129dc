#include "joint_fit.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

// Of the differences that stand for derivatives; the simulation is good to about 1e-9 of its values.
constexpr double kStep = 1e-5;
constexpr numerics::LeastSquaresLimits kLimits{40, 1e-6};
// Directions of the parameters whose information is below this part of the greatest count as not determined.
constexpr double kLeastInformation = 1e-12;
constexpr double kFarthest = 30.0;

Eigen::VectorXd coordinates(const std::vector<Parameter>& parameters, const Eigen::VectorXd& values) {
  Eigen::VectorXd c(values.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = coordinate(parameters[static_cast<std::size_t>(i)], values[i]);
  return c;
}

Eigen::VectorXd values_at(const std::vector<Parameter>& parameters, const Eigen::VectorXd& coordinates) {
  Eigen::VectorXd v(coordinates.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = value(parameters[static_cast<std::size_t>(i)], coordinates[i]);
  return v;
}

/// The whitened residuals of all experiments below each other, and their Jacobian by differences.
class Problem {
 public:
  Problem(const JointModel& model, std::span<const Experiment> experiments)
      : model_(model), experiments_(experiments), parameters_(model.parameters()) {
    for (const Experiment& e : experiments) rows_ += 2 * e.lines() - 1;
  }

  Eigen::Index rows() const { return rows_; }

  /// Parameters of the base model beyond kFarthest times their start are outside of the domain: a wrong model can pull them away
  /// without end.
  void bound_base(const Eigen::VectorXd& start) {
    bounds_ = start.head(static_cast<Eigen::Index>(model_.base->parameters().size()));
  }

  Eigen::VectorXd residual(const Eigen::VectorXd& coordinates) const {
    for (Eigen::Index i = 0; i < bounds_.size(); ++i) {
      if (parameters_[static_cast<std::size_t>(i)].logarithmic && !(std::abs(coordinates[i] - bounds_[i]) < std::log(kFarthest)))
        return Eigen::VectorXd::Constant(rows_, std::numeric_limits<double>::quiet_NaN());
    }
    const Eigen::VectorXd values = values_at(parameters_, coordinates);
    Eigen::VectorXd r(rows_);
    Eigen::Index at = 0;
    for (const Experiment& e : experiments_) {
      const Eigen::VectorXd part = whitened(e, model_.steady_state(e, values));
      r.segment(at, part.size()) = part;
      at += part.size();
    }
    return r;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& coordinates) const {
    const Eigen::VectorXd here = residual(coordinates);
    Eigen::MatrixXd j(rows_, coordinates.size());
    for (Eigen::Index i = 0; i < coordinates.size(); ++i) {
      Eigen::VectorXd moved = coordinates;
      moved[i] += kStep;
      j.col(i) = (residual(moved) - here) / kStep;
    }
    return j;
  }

 private:
  const JointModel& model_;
  std::span<const Experiment> experiments_;
  std::vector<Parameter> parameters_;
  Eigen::VectorXd bounds_;
  Eigen::Index rows_ = 0;
};

/// (J^T J)^-1 over the directions that the data determine.
Eigen::MatrixXd pseudo_inverse_normal(const Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd scale = jacobian.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = jacobian * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled.transpose() * scaled);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const double least = kLeastInformation * values.maxCoeff();
  const Eigen::VectorXd inverse = values.unaryExpr([least](double v) { return v > least ? 1.0 / v : 0.0; });
  const Eigen::MatrixXd half = scale.asDiagonal() * solver.eigenvectors();
  return half * inverse.asDiagonal() * half.transpose();
}

void set_uncertainty(const std::vector<Parameter>& parameters, const Eigen::MatrixXd& jacobian, Fit& f) {
  f.coordinate_covariance = pseudo_inverse_normal(jacobian);
  Eigen::VectorXd slopes(f.values.size());
  for (Eigen::Index i = 0; i < slopes.size(); ++i) slopes[i] = slope(parameters[static_cast<std::size_t>(i)], f.values[i]);
  f.covariance = slopes.asDiagonal() * f.coordinate_covariance * slopes.asDiagonal();
  f.std = f.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

std::vector<Parameter> JointModel::parameters() const {
  std::vector<Parameter> all = base->parameters();
  for (const Effect* effect : effects) {
    const std::vector<Parameter> own = effect->parameters();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

Extension JointModel::extension(const Eigen::VectorXd& values) const {
  Extension extension;
  auto at = static_cast<Eigen::Index>(base->parameters().size());
  for (const Effect* effect : effects) {
    const auto count = static_cast<Eigen::Index>(effect->parameters().size());
    extension.push_back({effect, values.segment(at, count)});
    at += count;
  }
  return extension;
}

Eigen::VectorXcd JointModel::steady_state(const Experiment& experiment, const Eigen::VectorXd& values) const {
  return base->steady_state(experiment, values, extension(values));
}

Eigen::VectorXd whitened(const Experiment& e, const Eigen::VectorXcd& predicted) {
  Eigen::VectorXd r(2 * e.lines() - 1);
  r[0] = (e.output[0] - predicted[0]).real() / std::sqrt(e.variance[0]);
  for (Eigen::Index k = 1; k < e.lines(); ++k) {
    const std::complex<double> error = (e.output[k] - predicted[k]) * std::sqrt(2.0 / e.variance[k]);
    r[2 * k - 1] = error.real();
    r[2 * k] = error.imag();
  }
  return r;
}

Expected<Fit> fit(const JointModel& model, std::span<const Experiment> experiments, const std::vector<Eigen::VectorXd>& starts) {
  const std::vector<Parameter> parameters = model.parameters();
  Problem problem(model, experiments);
  const numerics::LeastSquaresProblem least_squares{
      problem.rows(), [&problem](const Eigen::VectorXd& c, Eigen::VectorXd& r) { r = problem.residual(c); },
      [&problem](const Eigen::VectorXd& c, Eigen::MatrixXd& j) { j = problem.jacobian(c); }};
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& start : starts) {
    const Eigen::VectorXd at = coordinates(parameters, start);
    const double cost = problem.residual(at).squaredNorm();
    if (!(cost < least)) continue;
    least = cost;
    best = at;
  }
  if (best.size() == 0) return refused("the model can't be computed at any of the parameters to start from");
  problem.bound_base(best);
  const auto found = numerics::levenberg_marquardt(least_squares, best, kLimits);
  if (!found) return tl::unexpected(found.error());
  Fit f;
  f.model = model;
  f.values = values_at(parameters, found->parameters);
  f.chi2 = found->cost;
  f.converged = found->converged;
  set_uncertainty(parameters, found->jacobian, f);
  return f;
}

Prediction predict(const Fit& f, const Experiment& experiment) {
  const Problem problem(f.model, {&experiment, 1});
  Prediction p;
  p.lines = f.model.steady_state(experiment, f.values);
  p.residual = whitened(experiment, p.lines);
  p.jacobian = problem.jacobian(coordinates(f.model.parameters(), f.values));
  return p;
}

}  // namespace bodeflow::residual
