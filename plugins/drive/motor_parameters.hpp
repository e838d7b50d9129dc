#pragma once

#include <bodeflow/numerics/error.hpp>

/// Forms of the electrical parameters of an induction motor, all of them per phase of a star, rotor referred to the stator.
namespace bodeflow::drive {

/// Winding form: resistances [ohm], inductances [H] of stator and rotor, mutual inductance.
struct MotorParameters {
  double rs = 0.0;
  double rr = 0.0;
  double ls = 0.0;
  double lr = 0.0;
  double lm = 0.0;
};

/// The constants of Castaldi, Montanari, Tilli 2002, model (16): sigma [H] is the transient inductance of the stator,
/// beta [1/H], alpha and gamma [1/s], lm_beta = Lm beta is without a unit.
struct ModelConstants {
  double alpha = 0.0;
  double beta = 0.0;
  double gamma = 0.0;
  double sigma = 0.0;
  double lm_beta = 0.0;
};

/// T form: leakages beside one magnetising inductance.
struct TForm {
  double rs = 0.0;
  double rr = 0.0;
  double stator_leakage = 0.0;
  double rotor_leakage = 0.0;
  double lm = 0.0;
};

/// Inverse-Gamma form: all leakage on the stator's side. What a measurement at standstill can tell apart.
struct InverseGammaForm {
  double rs = 0.0;
  double rotor_resistance = 0.0;  ///< Rr (Lm / Lr)^2
  double leakage = 0.0;           ///< sigma
  double magnetising = 0.0;       ///< Lm^2 / Lr
};

/// The parameters, checked. Errors: a value that is not positive and finite, lm^2 >= ls lr.
numerics::Expected<MotorParameters> checked(const MotorParameters& p);

/// alpha = Rr / Lr, sigma = Ls - Lm^2 / Lr, beta = Lm / (sigma Lr), gamma = Rs / sigma + alpha Lm beta.
ModelConstants constants_of(const MotorParameters& p);
/// T form of the same motor; a leakage may be negative, since the split between stator and rotor is a choice.
TForm t_form(const MotorParameters& p);
InverseGammaForm inverse_gamma_form(const MotorParameters& p);

/// The motor with these constants. Four of them leave one freedom (rotor quantities scale with the turns ratio): where beta or
/// lm_beta is 0, it is left out and Ls = Lr is assumed. Errors: those of `checked`, both left out, gamma <= alpha lm_beta.
numerics::Expected<MotorParameters> from_constants(const ModelConstants& c);
numerics::Expected<MotorParameters> from_t_form(const TForm& t);
/// With Lr = Lm = magnetising inductance: rotor quantities as that form states them.
numerics::Expected<MotorParameters> from_inverse_gamma(const InverseGammaForm& g);

/// The constant mu = 3 Lm / (2 Lr) of the torque pole_pairs mu (psi_a i_b - psi_b i_a), which model (16) leaves out.
double torque_constant(const MotorParameters& p);

}  // namespace bodeflow::drive
