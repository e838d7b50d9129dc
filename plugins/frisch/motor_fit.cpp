#include "motor_fit.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <utility>

#include "motor_search.hpp"

namespace bodeflow::frisch {

namespace {

MotorModel from_logarithms(const Eigen::VectorXd& p) { return MotorModel::of(p.array().exp().matrix()); }

}  // namespace

numerics::LeastSquaresProblem motor_problem(Eigen::Index lines, LineResiduals residuals) {
  numerics::LeastSquaresProblem problem;
  problem.residuals = 2 * lines;
  problem.residual = [lines, residuals](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    const MotorModel m = from_logarithms(p);
    for (Eigen::Index k = 0; k < lines; ++k) {
      const auto value = residuals(m, k).value;
      r[k] = value.real();
      r[lines + k] = value.imag();
    }
  };
  problem.jacobian = [lines, residuals = std::move(residuals)](const Eigen::VectorXd& p, Eigen::MatrixXd& j) {
    const MotorModel m = from_logarithms(p);
    for (Eigen::Index k = 0; k < lines; ++k) {
      const auto slope = residuals(m, k).slope;
      j.row(k) = slope.real().transpose();
      j.row(lines + k) = slope.imag().transpose();
    }
  };
  return problem;
}

Eigen::Vector4d box_bias(const numerics::LeastSquaresProblem& problem, const numerics::LeastSquaresFit& fit,
                         const Eigen::Matrix4d& inverse_normal, double variance) {
  constexpr double kStep = 1e-4;  // of a logarithm: error of a central difference about 1e-8 of the second derivative
  Eigen::VectorXd trace = Eigen::VectorXd::Zero(problem.residuals);
  Eigen::MatrixXd up(problem.residuals, 4), down(problem.residuals, 4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::VectorXd p = fit.parameters;
    p[i] += kStep;
    problem.jacobian(p, up);
    p[i] -= 2.0 * kStep;
    problem.jacobian(p, down);
    trace += (up - down) * inverse_normal.col(i) / (2.0 * kStep);
  }
  return -0.5 * variance * inverse_normal * (fit.jacobian.transpose() * trace);
}

void set_uncertainty(const Eigen::Matrix4d& log_covariance, const Eigen::Vector4d& log_bias, MotorFit& fit) {
  const Eigen::Vector4d p = fit.model.vector();
  fit.covariance = p.asDiagonal() * log_covariance * p.asDiagonal();
  fit.bias = p.cwiseProduct(log_bias + 0.5 * log_covariance.diagonal());
}

Intervals intervals(const MotorFit& fit, double confidence) {
  const double q = numerics::normal_quantile(0.5 + 0.5 * confidence);
  const Eigen::Array4d p = fit.model.vector().array();
  const Eigen::Array4d spread = (q * fit.covariance.diagonal().array().sqrt() / p).exp();
  return {(p / spread).matrix(), (p * spread).matrix()};
}

Expected<MotorFit> fit_motor(const Eigen::VectorXd& omega, const Eigen::VectorXcd& measured, const Eigen::VectorXd& weight) {
  const auto start = motor_start(omega, measured);
  if (!start) return tl::make_unexpected(start.error());
  const Eigen::Index lines = omega.size();
  if (lines < 3) return refused("the fit needs at least 3 lines; found " + std::to_string(lines));
  if (weight.size() != lines) {
    return refused(std::to_string(weight.size()) + " weights for " + std::to_string(lines) + " lines");
  }
  if (!weight.allFinite() || weight.minCoeff() < 0.0) return refused("weights must be finite and at least 0");
  const auto problem = motor_problem(lines, [&](const MotorModel& m, Eigen::Index k) {
    const ResponseSlope g = response_slope(m, omega[k]);
    const double root = std::sqrt(weight[k]);
    return LineResidual{root * (g.value - measured[k]), root * g.slope};
  });
  const auto fit = numerics::levenberg_marquardt(problem, start->vector().array().log().matrix());
  if (!fit) return tl::make_unexpected(fit.error());
  const auto inverse = numerics::inverse_normal_matrix(fit->jacobian, motor_parameter_names());
  if (!inverse) return tl::make_unexpected(inverse.error());
  MotorFit f;
  f.model = from_logarithms(fit->parameters);
  f.cost = fit->cost;
  f.expected_cost = std::nan("");
  f.converged = fit->converged;
  f.reason = fit->reason;
  const double degrees = static_cast<double>(2 * lines - MotorModel::kParameters);
  const Eigen::MatrixXd scaled = fit->residual.asDiagonal() * fit->jacobian * *inverse;
  const Eigen::Matrix4d covariance = scaled.transpose() * scaled * (2.0 * static_cast<double>(lines) / degrees);
  set_uncertainty(covariance, box_bias(problem, *fit, *inverse, fit->cost / degrees), f);
  return f;
}

}  // namespace bodeflow::frisch
