#pragma once

#include <bodeflow/plant.hpp>
#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace bodeflow::residual {

/// The lines of an impedance above frequency 0, with the mass that was added.
struct ImpedanceLines {
  std::vector<double> omega;
  std::vector<std::complex<double>> impedance;
  double added_mass = 0.0;
};

/// The records as impedances. Throws Failure for records without a line or with a response of 0.
std::vector<ImpedanceLines> impedance_lines(std::span<const MeasuredResponse> measured, bool admittance);

/// The least real part. Throws Failure where there is none above 0: no passive impedance.
double coil_resistance(const std::vector<ImpedanceLines>& records);

/// Inductances that fit the upper end and the middle of the inductive range of the first record.
std::vector<double> coil_inductances(const std::vector<ImpedanceLines>& records);

struct DriverStart {
  double force_factor, mass, mechanical_resistance, stiffness;
};

/// What the resonances say: their frequencies f_i of the masses, m = (m_j f_j^2 - m_i f_i^2) / (f_i^2 - f_j^2) from two added
/// masses m_i, their height Bl^2 / r and their width r / (2 pi (m + m_i)). Throws Failure where no record has a resonance, or the
/// added masses do not differ (or do not lower it) and the force factor is not declared.
DriverStart driver_start(const std::vector<ImpedanceLines>& records, double resistance, std::optional<double> force_factor);

}  // namespace bodeflow::residual
