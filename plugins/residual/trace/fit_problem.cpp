#include "trace/fit_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

constexpr double kLeastInformation = 1e-12;
constexpr double kFarthest = 30.0;

}  // namespace

FitProblem::FitProblem(const JointModel& model, const Measurements& records, Eigen::Index settled)
    : model_(model), records_(records), layout_(model.parameters(), records.size()) {
  for (const auto& r : records) {
    begin_.push_back(rows_);
    step_ = std::max(step_, r->difference_step(model));
    rows_ += r->rows();
  }
  settled_.assign(static_cast<std::size_t>(layout_.size()), false);
  for (std::size_t p = 0; p < static_cast<std::size_t>(settled < 0 ? model.base_count() : settled); ++p)
    for (std::size_t r = 0; r < records.size(); ++r) settled_[static_cast<std::size_t>(layout_.index(p, r))] = true;
}

bool FitProblem::inside(const Eigen::VectorXd& c) const {
  if (bounds_.size() == 0) return true;
  for (std::size_t p = 0; p < static_cast<std::size_t>(model_.base_count()); ++p) {
    if (!layout_.parameters()[p].logarithmic) continue;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const Eigen::Index i = layout_.index(p, r);
      if (!(std::abs(c[i] - bounds_[i]) < std::log(kFarthest))) return false;
    }
  }
  return true;
}

Eigen::VectorXd FitProblem::within_bounds(Eigen::VectorXd c) const {
  for (std::size_t p = 0; p < static_cast<std::size_t>(model_.base_count()); ++p) {
    const FitParameter& parameter = layout_.parameters()[p];
    if (parameter.logarithmic) continue;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      double& value = c[layout_.index(p, r)];
      value = std::clamp(value, parameter.low / parameter.scale, parameter.high / parameter.scale);
    }
  }
  return c;
}

Eigen::VectorXd FitProblem::residual(const Eigen::VectorXd& coordinates) const {
  const Eigen::VectorXd c = within_bounds(coordinates);
  if (!c.allFinite() || !inside(c)) return Eigen::VectorXd::Constant(rows_, std::numeric_limits<double>::quiet_NaN());
  Eigen::VectorXd all(rows_);
  for (std::size_t r = 0; r < records_.size(); ++r)
    all.segment(begin_[r], records_[r]->rows()) = records_[r]->residual(model_, layout_.values(c, r));
  return all;
}

Eigen::VectorXd FitProblem::difference(Eigen::Index i, double step, const Eigen::VectorXd& c, const Eigen::VectorXd& here) const {
  Eigen::VectorXd moved = c;
  moved[i] += step;
  if (layout_.is_shared(i)) return (residual(moved) - here) / step;
  const std::size_t r = layout_.record_of(i);
  Eigen::VectorXd column = Eigen::VectorXd::Zero(rows_);
  const Eigen::Index count = records_[r]->rows();
  column.segment(begin_[r], count) =
      (records_[r]->residual(model_, layout_.values(moved, r)) - here.segment(begin_[r], count)) / step;
  return column;
}

Eigen::VectorXd FitProblem::column(Eigen::Index i, const Eigen::VectorXd& c, const Eigen::VectorXd& here) const {
  Eigen::VectorXd moved = c;
  moved[i] += step_;
  if (within_bounds(moved)[i] < moved[i]) return difference(i, -step_, c, here);
  Eigen::VectorXd forward = difference(i, step_, c, here);
  return forward.allFinite() ? forward : difference(i, -step_, c, here);
}

Eigen::MatrixXd FitProblem::jacobian(const Eigen::VectorXd& c, const Eigen::VectorXd& here) const {
  Eigen::MatrixXd j(rows_, c.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) j.col(i) = column(i, c, here);
  return j;
}

Eigen::MatrixXd pseudo_inverse_normal(const Eigen::MatrixXd& jacobian) {
  if (jacobian.rows() == 0) return Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  const Eigen::VectorXd scale = jacobian.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = jacobian * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled.transpose() * scaled);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const double least = kLeastInformation * values.maxCoeff();
  const Eigen::VectorXd inverse = values.unaryExpr([least](double v) { return v > least ? 1.0 / v : 0.0; });
  const Eigen::MatrixXd half = scale.asDiagonal() * solver.eigenvectors();
  return half * inverse.asDiagonal() * half.transpose();
}

}  // namespace bodeflow::residual
