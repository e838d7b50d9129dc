#pragma once

#include "generate/plant.hpp"

namespace battery {

/// Mass, damper and spring, mass x'' + damping x' + stiffness x = force: measured force [N] to position [m].
class Oscillator : public Plant {
 public:
  double mass = 1.0, damping = 3.0, stiffness = 4000.0;
  double force_rms = 10.0;

  /// 8 to 12 Hz, damping ratio 1.5 to 3.5 %, 0.5 to 2 kg, 3 to 30 N rms.
  static Oscillator draw(Random& random);

  std::string name() const override { return "mechanical"; }
  std::string input_unit() const override { return "N"; }
  std::string output_unit() const override { return "m"; }
  double sample_time() const override { return 5e-3; }
  double input_rms() const override { return force_rms; }
  bool input_is_measured() const override { return true; }
  std::vector<int> line_choice() const override;
  Series clean(const Drive& d) const override;
  std::vector<double> parameters() const override { return {1.0 / mass, damping / mass, stiffness / mass}; }
  Complex response(const std::vector<double>& parameters, double omega) const override;
};

}  // namespace battery
