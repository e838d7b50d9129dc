#pragma once

#include <Eigen/Core>

#include "motor_fit.hpp"

namespace bodeflow::frisch {

/// What the terminals tell of a motor at standstill, with covariance in this order. Only these four: (Lm, Lr, Rr) -> (k Lm, k^2
/// Lr, k^2 Rr) leaves the response as it is.
struct IdentifiableParameters {
  double stator_resistance_ohm = 0.0;  ///< Rs = sigma (gamma - alpha Lm_beta)
  double stator_inductance_h = 0.0;    ///< Ls = sigma (1 + Lm_beta)
  double rotor_time_constant_s = 0.0;  ///< Lr/Rr = 1/alpha
  double leakage_inductance_h = 0.0;   ///< sigma
  Eigen::Matrix4d covariance;
};
IdentifiableParameters identifiable_parameters(const MotorFit& fit);

/// The five parameters of the paper's Table 1 under the assumption Ls = Lr, with covariance in this order (of rank 4). Another
/// ratio of Ls to Lr gives another set with the same response.
struct EqualInductanceParameters {
  double stator_resistance_ohm = 0.0;  ///< Rs
  double rotor_resistance_ohm = 0.0;   ///< Rr = alpha Lr
  double stator_inductance_h = 0.0;    ///< Ls
  double rotor_inductance_h = 0.0;     ///< Lr = Ls
  double mutual_inductance_h = 0.0;    ///< Lm = sqrt(Lr sigma Lm_beta)
  Eigen::Matrix<double, 5, 5> covariance;
};
EqualInductanceParameters equal_inductance_parameters(const MotorFit& fit);

/// The model of given resistances [ohm] and inductances [H]. Errors: a value that is not positive and finite; Lm^2 >= Ls Lr.
Expected<MotorModel> motor_model(double Rs, double Rr, double Ls, double Lr, double Lm);

}  // namespace bodeflow::frisch
