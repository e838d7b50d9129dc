#include "trace/held_out.hpp"

#include <bodeflow/numerics/levenberg_marquardt.hpp>

namespace bodeflow::residual {
namespace {

// The prior variance of a parameter that the held-out record alone determines, in units of what that record leaves open.
constexpr double kFree = 1e6;
constexpr numerics::LeastSquaresLimits kLimits{40, 1e-6};

// A measurement that is not owned.
Measurements alone(const Measurement& record) {
  return {std::shared_ptr<const Measurement>(std::shared_ptr<const Measurement>(), &record)};
}

}  // namespace

Expected<HeldOut> hold_out(const JointModel& model, const Eigen::VectorXd& values, const Measurement& record) {
  const Measurements records = alone(record);
  const FitProblem problem(model, records);
  const Coordinates& layout = problem.layout();
  Eigen::VectorXd at = layout.of(values);
  HeldOut h;
  h.residual = problem.residual(at);
  if (!h.residual.allFinite()) return refused("the model can't be computed on record '" + record.facts().name + "'");
  if (layout.own() > 0) {
    const Eigen::Index shared = layout.shared(), own = layout.own();
    const auto whole = [&](const Eigen::VectorXd& c) {
      Eigen::VectorXd all = at;
      all.tail(own) = c;
      return all;
    };
    const numerics::LeastSquaresProblem problem_of_own{
        problem.rows(), [&](const Eigen::VectorXd& c, Eigen::VectorXd& r) { r = problem.residual(whole(c)); },
        [&](const Eigen::VectorXd& c, Eigen::MatrixXd& j) {
          const Eigen::VectorXd all = whole(c), here = problem.residual(all);
          for (Eigen::Index i = 0; i < own; ++i) j.col(i) = problem.column(shared + i, all, here);
        }};
    const auto found = numerics::levenberg_marquardt(problem_of_own, at.tail(own), kLimits);
    if (!found) return tl::unexpected(found.error());
    at = whole(found->parameters);
    h.residual = found->residual;
  }
  h.values = layout.values(at, 0);
  h.fitted = layout.own() + record.eliminated(model, h.values);
  return h;
}

std::vector<ClassTest> fitted_tests(const Fit& fit, const Measurements& records, std::size_t record) {
  Eigen::Index begin = 0;
  for (std::size_t r = 0; r < record; ++r) begin += records[r]->rows();
  const Eigen::Index count = records[record]->rows();
  return records[record]->tests(fit.residual.segment(begin, count), fit.jacobian.middleRows(begin, count), fit.covariance, true);
}

std::vector<ClassTest> held_out_tests(const Fit& fit, const HeldOut& held_out, const Measurement& record) {
  const Measurements records = alone(record);
  const FitProblem problem(fit.model, records);
  const Eigen::MatrixXd jacobian = problem.jacobian(problem.layout().of(held_out.values), held_out.residual);
  const Eigen::Index shared = problem.layout().shared(), own = problem.layout().own();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(shared + own, shared + own);
  covariance.topLeftCorner(shared, shared) = fit.covariance.topLeftCorner(shared, shared);
  if (own > 0) covariance.bottomRightCorner(own, own) = kFree * pseudo_inverse_normal(jacobian.rightCols(own));
  return record.tests(held_out.residual, jacobian, covariance, false);
}

}  // namespace bodeflow::residual
