#include "classical_tests.hpp"

#include <cmath>
#include <numbers>

#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

using Complex = std::complex<double>;
using records::short_number;

constexpr double kTurn = 2 * std::numbers::pi;

std::string text(const PhaseImpedance& z) {
  return short_number(z.value.real()) + " + j " + short_number(z.value.imag()) + " ohm at " + short_number(z.frequency_hz) +
         " Hz";
}

}  // namespace

numerics::Expected<MotorParameters> motor_of_tests(double direct_resistance_ohm, const PhaseImpedance& no_load,
                                                   const PhaseImpedance& locked_rotor) {
  if (!(direct_resistance_ohm > 0)) {
    return numerics::refused("dc: resistance is " + short_number(direct_resistance_ohm) + " ohm, allowed: above 0");
  }
  if (!(no_load.frequency_hz > 0) || !(no_load.value.imag() > 0)) {
    return numerics::refused("no_load: " + text(no_load) + "; allowed: frequency and reactance above 0");
  }
  if (!(locked_rotor.frequency_hz > 0)) {
    return numerics::refused("locked_rotor: " + text(locked_rotor) + "; allowed: a frequency above 0");
  }
  MotorParameters motor;
  motor.rs = direct_resistance_ohm;
  motor.ls = motor.lr = no_load.value.imag() / (kTurn * no_load.frequency_hz);
  const double omega = kTurn * locked_rotor.frequency_hz;
  const Complex rotor = 1.0 / (locked_rotor.value - motor.rs - Complex(0, omega * motor.ls));  // (Rr + j w Lr) / (w Lm)^2
  if (!(rotor.real() > 0) || !(rotor.imag() > 0)) {
    return numerics::refused("locked_rotor: " + text(locked_rotor) + "; allowed with " + short_number(motor.rs) +
                             " ohm at dc and " + text(no_load) +
                             " without load: more resistance than at dc and less reactance than without load");
  }
  motor.rr = omega * motor.lr * rotor.real() / rotor.imag();
  motor.lm = std::sqrt(motor.lr / (rotor.imag() * omega));
  return checked(motor);
}

std::complex<double> phase_impedance(const MotorParameters& motor, double frequency_hz, double slip) {
  const double omega = kTurn * frequency_hz;
  const Complex stator(motor.rs, omega * motor.ls);
  return stator + std::pow(omega * motor.lm, 2) * slip / Complex(motor.rr, slip * omega * motor.lr);
}

}  // namespace bodeflow::drive
