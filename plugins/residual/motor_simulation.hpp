#pragma once

#include <Eigen/Core>

#include "effect.hpp"
#include "motor_parameters.hpp"

namespace bodeflow::residual {

/// How the input drives the motor and when the current is sampled.
struct Timing {
  double sample_time_s = 0.0;
  int held_per_sample = 1;  ///< the input is given so many times a sample, and held between
  double delay_s = 0.0;     ///< from input to output, of any size and sign
  int steps_per_sample = 1;
};

/// One period of the current for a period of the voltage (`held_per_sample` values a sample), with the effects of the extension.
///
/// The period is run after as much of it as the slower mode takes to fall to e^-14. Steps end at every change of the input and at
/// every sample of the current; the delay shifts these instants, so it is exact.
/// What is lost is held over each step at its value for the current at the start, as an inverter holds it over a PWM period.
/// Without an effect that stores, the modes of (17) are moved exactly. Otherwise classical Runge-Kutta steps with stator current
/// i and main flux psi as states:
///   psi' = (a + b) / (2 + l c),  i' = (a - psi') / l,  a = u - lost - Rs i,  b = Rr (i - i_m(psi)),  c = d i_m / d psi.
/// Parameters outside of the domain give values that are not finite. Cost: about 10 or 40 ns a step.
Eigen::VectorXd simulate(const Eigen::Vector4d& parameters, const Timing& timing, const Eigen::VectorXd& voltage,
                         const Extension& extension);

}  // namespace bodeflow::residual
