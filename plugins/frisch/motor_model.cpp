#include "motor_model.hpp"

#include <cmath>

namespace bodeflow::frisch {

using Complex = std::complex<double>;

const std::vector<std::string>& motor_parameter_names() {
  static const std::vector<std::string> names = {"gamma", "alpha", "Lm_beta", "sigma"};
  return names;
}

std::complex<double> response(const MotorModel& m, double omega) {
  const Complex s(0.0, omega);
  return (s + m.alpha) / (m.sigma * (s * s + s * (m.gamma + m.alpha) + m.alpha * (m.gamma - m.alpha * m.lm_beta)));
}

Eigen::VectorXcd response(const MotorModel& model, const Eigen::VectorXd& omega) {
  return omega.unaryExpr([&](double w) { return response(model, w); });
}

Eigen::Vector2d transfer_numerator(const MotorModel& m) { return Eigen::Vector2d(1.0, m.alpha) / m.sigma; }

Eigen::Vector3d transfer_denominator(const MotorModel& m) {
  return {1.0, m.gamma + m.alpha, m.alpha * (m.gamma - m.alpha * m.lm_beta)};
}

Eigen::Vector2d poles(const MotorModel& model) {
  const Eigen::Vector3d d = transfer_denominator(model);
  const double fast = -0.5 * (d[1] + std::sqrt(d[1] * d[1] - 4.0 * d[2]));
  return {d[2] / fast, fast};
}

ResponseSlope response_slope(const MotorModel& m, double omega) {
  const Complex s(0.0, omega);
  const Complex denominator = s * s + s * (m.gamma + m.alpha) + m.alpha * (m.gamma - m.alpha * m.lm_beta);
  const Complex g = (s + m.alpha) / (m.sigma * denominator);
  ResponseSlope r;
  r.value = g;
  r.slope[0] = -m.gamma * g * (s + m.alpha) / denominator;
  r.slope[1] = m.alpha * (1.0 / m.sigma - g * (s + m.gamma - 2.0 * m.alpha * m.lm_beta)) / denominator;
  r.slope[2] = m.lm_beta * g * m.alpha * m.alpha / denominator;
  r.slope[3] = -g;
  return r;
}

}  // namespace bodeflow::frisch
