#pragma once

#include "generate/plant.hpp"

namespace battery {

/// A lag residue / (s - pole).
struct Mode {
  double pole = 0.0;
  double residue = 0.0;
};

/// Induction motor at standstill, one phase: the T circuit. Command voltage held over each sample [V] to current [A].
class Motor : public Plant {
 public:
  double rs = 6.6, rr = 5.5;  ///< [ohm]
  double leakage = 0.021;     ///< of stator and of rotor [H]
  double lm = 0.454;          ///< [H]
  double voltage_rms = 20.0;

  /// Every parameter within 8 % of the motor of Castaldi, Montanari, Tilli (2002), 12 to 40 V rms.
  static Motor draw(Random& random);

  /// The two modes of i / v = (s + alpha) / sigma / (s^2 + (gamma + alpha) s + alpha (gamma - alpha Lm beta)).
  std::vector<Mode> modes() const;
  /// From gamma, alpha, Lm beta, 1 / sigma.
  static std::vector<Mode> modes(const std::vector<double>& parameters);
  /// i / v of the circuit, where the rotor's resistance is multiplied by a factor.
  Complex admittance(Complex s, Complex rotor_factor) const;

  std::string name() const override { return "motor"; }
  std::string input_unit() const override { return "V"; }
  std::string output_unit() const override { return "A"; }
  double sample_time() const override { return 1e-3; }
  double input_rms() const override { return voltage_rms; }
  bool input_is_measured() const override { return false; }
  std::vector<int> line_choice() const override;
  Series clean(const Drive& d) const override;
  std::vector<double> parameters() const override;
  Complex response(const std::vector<double>& parameters, double omega) const override;
};

/// Output of parallel modes, exact at every substep, settling included, for an input held over each sample and looked at `delay`
/// seconds later.
Series held_response(const std::vector<Mode>& modes, const Drive& d, double delay);

}  // namespace battery
