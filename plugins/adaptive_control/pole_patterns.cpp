#include "pole_patterns.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::adaptive_control {

Eigen::VectorXd bessel(int order, double omega) {
  Eigen::VectorXd theta(order + 1);
  theta[0] = 1.0;
  // (n+k)! / ((n-k)! k! 2^k) over the same with k - 1 is (n + k)(n - k + 1) / (2 k).
  for (int k = 1; k <= order; ++k) theta[k] = theta[k - 1] * (order + k) * (order - k + 1) / (2.0 * k);
  const double radius = std::pow(theta[order], 1.0 / order);
  return faster(theta, omega / radius);
}

Eigen::VectorXd butterworth(int order, double omega, double alpha) {
  Eigen::VectorXd polynomial = Eigen::VectorXd::Ones(1);
  if (order % 2 == 1) polynomial = Eigen::Vector2d(1.0, omega);
  for (int i = 0; i < order / 2; ++i) {
    const double phi = alpha * (1.0 - 2.0 * i / (order - 1));
    polynomial = numerics::multiply(polynomial, Eigen::Vector3d(1.0, 2.0 * omega * std::cos(phi), omega * omega));
  }
  return polynomial;
}

Eigen::VectorXd dominant_poles(int order, double omega, double ratio) {
  if (order <= 2) return bessel(order, omega);
  return numerics::multiply(bessel(2, omega), bessel(order - 2, ratio * omega));
}

Eigen::VectorXd real_poles(int order, double omega) {
  Eigen::VectorXd polynomial = Eigen::VectorXd::Ones(1);
  for (int i = 0; i < order; ++i) polynomial = numerics::multiply(polynomial, Eigen::Vector2d(1.0, omega));
  return polynomial;
}

Eigen::VectorXd faster(const Eigen::VectorXd& polynomial, double factor) {
  Eigen::VectorXd scaled = polynomial;
  double power = 1.0;
  for (double& coefficient : scaled) {
    coefficient *= power;
    power *= factor;
  }
  return scaled;
}

}  // namespace bodeflow::adaptive_control
