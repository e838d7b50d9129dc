#pragma once

#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <functional>

#include "motor_fit.hpp"

namespace bodeflow::frisch {

/// A complex residual of one line and its slope by the logarithms of the parameters.
struct LineResidual {
  std::complex<double> value;
  Eigen::Vector4cd slope;
};
using LineResiduals = std::function<LineResidual(const MotorModel&, Eigen::Index line)>;

/// The least-squares problem over the logarithms of the parameters, real parts before imaginary parts.
numerics::LeastSquaresProblem motor_problem(Eigen::Index lines, LineResiduals residuals);

/// Box's bias of the logarithms for residuals of variance `variance` each (real numbers):
///   -1/2 (J^T J)^-1 J^T [trace((J^T J)^-1 H_i)]_i variance, H_i the second derivatives of residual i.
Eigen::Vector4d box_bias(const numerics::LeastSquaresProblem& problem, const numerics::LeastSquaresFit& fit,
                         const Eigen::Matrix4d& inverse_normal, double variance);

/// Covariance and bias of the parameters from those of their logarithms.
void set_uncertainty(const Eigen::Matrix4d& log_covariance, const Eigen::Vector4d& log_bias, MotorFit& fit);

}  // namespace bodeflow::frisch
