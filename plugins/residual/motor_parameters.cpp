#include "motor_parameters.hpp"

#include <cmath>

namespace bodeflow::residual {

TCircuit t_circuit(const Eigen::Vector4d& p) {
  const double gamma = p[0], alpha = p[1], lm_beta = p[2], sigma = p[3];
  const double ls = sigma * (1.0 + lm_beta), lm = std::sqrt(ls * sigma * lm_beta);
  return {sigma * (gamma - alpha * lm_beta), alpha * ls, ls - lm, lm};
}

MotorModes motor_modes(const Eigen::Vector4d& p) {
  const double gamma = p[0], alpha = p[1], lm_beta = p[2], sigma = p[3];
  const double root = std::sqrt((gamma - alpha) * (gamma - alpha) + 4.0 * alpha * alpha * lm_beta);
  MotorModes m;
  m.pole[0] = -(gamma + alpha + root) / 2.0;
  m.pole[1] = alpha * (gamma - alpha * lm_beta) / m.pole[0];  // the product of the poles: no difference of near numbers
  for (int i = 0; i < 2; ++i) m.residue[i] = (m.pole[i] + alpha) / (sigma * (m.pole[i] - m.pole[1 - i]));
  return m;
}

}  // namespace bodeflow::residual
