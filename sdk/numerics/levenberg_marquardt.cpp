#include "bodeflow/numerics/levenberg_marquardt.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

namespace bodeflow::numerics {

namespace {

constexpr double kLeastSingularValue = 1e-10;  // of columns of unit length: below, rounding decides the covariance

// What Eigen's solver asks of a problem.
struct Functor {
  const LeastSquaresProblem& problem;
  int values() const { return static_cast<int>(problem.residuals); }
  int operator()(const Eigen::VectorXd& p, Eigen::VectorXd& r) const {
    problem.residual(p, r);
    return 0;
  }
  int df(const Eigen::VectorXd& p, Eigen::MatrixXd& j) const {
    problem.jacobian(p, j);
    return 0;
  }
};

std::string words(Eigen::LevenbergMarquardtSpace::Status status) {
  using namespace Eigen::LevenbergMarquardtSpace;
  switch (status) {
    case RelativeReductionTooSmall:
    case FtolTooSmall:
      return "the cost falls no further";
    case RelativeErrorTooSmall:
    case XtolTooSmall:
      return "the parameters move no further";
    case RelativeErrorAndReductionTooSmall:
      return "neither cost nor parameters move further";
    case CosinusTooSmall:
    case GtolTooSmall:
      return "the residual stands at right angles to every column of the Jacobian";
    case TooManyFunctionEvaluation:
      return "the evaluations allowed are used up";
    default:
      return "the search could not go on";
  }
}

bool is_end(Eigen::LevenbergMarquardtSpace::Status status) {
  using namespace Eigen::LevenbergMarquardtSpace;
  return status != TooManyFunctionEvaluation && status != ImproperInputParameters && status != UserAsked;
}

}  // namespace

Expected<LeastSquaresFit> levenberg_marquardt(const LeastSquaresProblem& problem, const Eigen::VectorXd& start,
                                              const LeastSquaresLimits& limits) {
  if (problem.residuals < start.size()) {
    return refused(std::to_string(problem.residuals) + " residuals do not determine " + std::to_string(start.size()) +
                   " parameters");
  }
  LeastSquaresFit fit;
  fit.parameters = start;
  fit.residual.resize(problem.residuals);
  fit.jacobian.resize(problem.residuals, start.size());
  problem.residual(start, fit.residual);
  problem.jacobian(start, fit.jacobian);
  if (!fit.residual.allFinite() || !fit.jacobian.allFinite()) {
    return refused("the residuals are not finite at the starting values");
  }
  Functor functor{problem};
  Eigen::LevenbergMarquardt<Functor> search(functor);
  search.parameters.maxfev = limits.evaluations;
  search.parameters.ftol = limits.tolerance;
  search.parameters.xtol = limits.tolerance;
  const auto status = search.minimize(fit.parameters);
  fit.evaluations = static_cast<int>(search.nfev);
  fit.converged = is_end(status);
  fit.reason = words(status);
  problem.residual(fit.parameters, fit.residual);
  problem.jacobian(fit.parameters, fit.jacobian);
  fit.cost = fit.residual.squaredNorm();
  return fit;
}

Expected<Eigen::MatrixXd> inverse_normal_matrix(const Eigen::MatrixXd& jacobian, const std::vector<std::string>& names) {
  const auto name = [&](Eigen::Index i) {
    return names.empty() ? "parameter " + std::to_string(i + 1) : names[static_cast<std::size_t>(i)];
  };
  const Eigen::VectorXd length = jacobian.colwise().norm();
  for (Eigen::Index i = 0; i < length.size(); ++i) {
    if (!(length[i] > 0.0) || !std::isfinite(length[i])) return refused("the data say nothing about " + name(i));
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian * length.cwiseInverse().asDiagonal(), Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  if (jacobian.rows() < jacobian.cols() || s[s.size() - 1] < kLeastSingularValue * s[0]) {
    Eigen::Index greatest = 0;
    svd.matrixV().col(jacobian.cols() - 1).cwiseAbs().maxCoeff(&greatest);
    return refused("the data leave a combination of the parameters free, " + name(greatest) + " above all");
  }
  const Eigen::MatrixXd root = length.cwiseInverse().asDiagonal() * svd.matrixV() * s.cwiseInverse().asDiagonal();
  return Eigen::MatrixXd(root * root.transpose());
}

}  // namespace bodeflow::numerics
