#pragma once

#include <complex>

#include "motor_parameters.hpp"

namespace bodeflow::drive {

/// Impedance of a phase of the star [ohm] at a frequency.
struct PhaseImpedance {
  double frequency_hz = 0.0;
  std::complex<double> value;
};

/// The motor that has these impedances: Rs from a test with direct current, Ls from a test without load at synchronous speed,
/// where no current flows in the rotor, and rotor and mutual inductance from a test with the rotor locked.
///
/// Equivalent circuit of a phase, rotor referred to the stator: Z = Rs + j w Ls + w^2 Lm^2 / (Rr / slip + j w Lr). At slip 0 the
/// imaginary part is w Ls. At slip 1, with W = Z - Rs - j w Ls and Lr = Ls: Rr = w Lr Re(1/W) / Im(1/W), Lm^2 = |W| |Rr + j w Lr|
/// / w^2. This is what the iteration of IEEE Std 112 (method 1, equal leakages) goes to, in closed form; the short formula Rr =
/// Re Z - Rs leaves the magnetising branch out. What the tests cannot tell: the ratio of Lr to Ls (taken as 1), and a resistance
/// or a leakage that changes with frequency: Rr is that at the frequency of the test. Errors, by name: a resistance or frequency
/// that is not above 0, impedances that no such motor has. Reference: W. Leonhard, Control of Electrical Drives, 1995,
/// chapter 10.
numerics::Expected<MotorParameters> motor_of_tests(double direct_resistance_ohm, const PhaseImpedance& no_load,
                                                   const PhaseImpedance& locked_rotor);

/// The impedance of a phase of that motor; the rotor slips by `slip`, 1: locked, 0: synchronous.
std::complex<double> phase_impedance(const MotorParameters& motor, double frequency_hz, double slip);

}  // namespace bodeflow::drive
