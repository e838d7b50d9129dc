#pragma once

#include <Eigen/Core>

namespace bodeflow::residual {

/// One phase of an induction motor at standstill as a T circuit with Ls = Lr, which the stator alone can't tell from any other
/// split of the leakage. Equivalent to the transfer function
///   G(s) = (s + alpha)/sigma / (s^2 + s (gamma + alpha) + alpha (gamma - alpha Lm_beta))   (17)
/// with alpha = Rr/Lr, Lm_beta = Lm^2/(sigma Lr), sigma = Ls - Lm^2/Lr, gamma = Rs/sigma + alpha Lm_beta.
/// Reference: P. Castaldi, M. Montanari, A. Tilli, Induction motor model identification via frequency-domain Frisch scheme, IFAC
/// World Congress 2002, equations (16) and (17).
struct TCircuit {
  double rs = 0.0;       ///< [ohm]
  double rr = 0.0;       ///< [ohm]
  double leakage = 0.0;  ///< of stator and rotor each [H]
  double lm = 0.0;       ///< [H]
};

/// The circuit of (gamma, alpha, Lm_beta, sigma), all above 0.
TCircuit t_circuit(const Eigen::Vector4d& parameters);

/// The two modes of (17): G(s) = sum_i residue_i / (s - pole_i). Both poles are real.
struct MotorModes {
  Eigen::Vector2d pole;     ///< [rad/s]
  Eigen::Vector2d residue;  ///< [A/(V s)]
};
MotorModes motor_modes(const Eigen::Vector4d& parameters);

}  // namespace bodeflow::residual
