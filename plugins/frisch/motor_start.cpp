#include <Eigen/QR>
#include <cmath>

#include "motor_model.hpp"

namespace bodeflow::frisch {

namespace {

using Complex = std::complex<double>;

constexpr int kReweightings = 3;

// x = [a1 a0 b1 b0] of G (s^2 + a1 s + a0) = b1 s + b0, each line divided by `weight`, s already scaled.
Eigen::Vector4d linear_fit(const Eigen::VectorXcd& s, const Eigen::VectorXcd& g, const Eigen::VectorXd& weight) {
  const Eigen::Index lines = s.size();
  Eigen::MatrixXd rows(2 * lines, 4);
  Eigen::VectorXd right(2 * lines);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Eigen::RowVector4cd row = Eigen::RowVector4cd(g[k] * s[k], g[k], -s[k], -1.0) / weight[k];
    const Complex value = -g[k] * s[k] * s[k] / weight[k];
    rows.row(k) = row.real();
    rows.row(lines + k) = row.imag();
    right[k] = value.real();
    right[lines + k] = value.imag();
  }
  return rows.colPivHouseholderQr().solve(right);
}

double positive_or(double value, double otherwise) { return std::isfinite(value) && value > 0.0 ? value : otherwise; }

}  // namespace

Expected<MotorModel> motor_start(const Eigen::VectorXd& omega, const Eigen::VectorXcd& response) {
  if (omega.size() != response.size()) {
    return refused(std::to_string(omega.size()) + " frequencies for " + std::to_string(response.size()) + " lines");
  }
  if (omega.size() < 2) return refused("the motor model needs at least 2 lines; found " + std::to_string(omega.size()));
  if (!response.allFinite() || !omega.allFinite() || !(omega.minCoeff() > 0.0)) {
    return refused("responses must be finite, frequencies finite and above 0");
  }
  // The geometric mean of the frequencies as unit keeps the columns alike in size.
  const double unit = std::exp(omega.array().log().mean());
  const Eigen::VectorXcd s = Complex(0.0, 1.0 / unit) * omega;
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(omega.size());
  Eigen::Vector4d x;
  for (int i = 0; i <= kReweightings; ++i) {
    x = linear_fit(s, response, weight);
    weight = (s.array().square() + x[0] * s.array() + x[1]).abs();
    if (!(weight.minCoeff() > 0.0)) break;
  }
  const double a1 = x[0] * unit, a0 = x[1] * unit * unit, b1 = x[2] * unit, b0 = x[3] * unit * unit;
  MotorModel m;
  m.sigma = positive_or(1.0 / b1, 1.0 / (response.cwiseAbs().minCoeff() * omega.maxCoeff()));
  m.alpha = positive_or(b0 / b1, unit);
  m.gamma = positive_or(a1 - m.alpha, omega.maxCoeff());
  m.lm_beta = positive_or((m.gamma - a0 / m.alpha) / m.alpha, 1.0);
  return m;
}

}  // namespace bodeflow::frisch
