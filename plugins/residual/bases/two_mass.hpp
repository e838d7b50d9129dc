#pragma once

#include <bodeflow/base_model.hpp>
#include <string>

namespace bodeflow::residual {

/// residual.two_mass: a motor and a load on an elastic coupling,
///   J1 dw1/dt = M - d1 w1 - k (q1 - q2) - c (w1 - w2),   J2 dw2/dt = k (q1 - q2) + c (w1 - w2) - d2 w2,
/// q angles, w speeds, M the torque. Measured behind a current whose torque constant is not known, all coefficients are those per
/// torque constant, in A: only they can be found. From the load's movement alone 5 numbers can be found, so there the viscous
/// friction is that of the motor.
class TwoMass final : public BaseModel {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override;
  Timing timing() const override { return timing_; }
  std::string response_unit() const override { return std::string(speed_ ? "rad/s" : "rad") + (current_ ? "/A" : "/(N*m)"); }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;

 private:
  std::string effort_unit() const { return current_ && torque_constant_ <= 0.0 ? "A" : "Nm"; }
  /// What a unit of the input is in units of the effort.
  double effort_of_input() const { return current_ && torque_constant_ > 0.0 ? torque_constant_ : 1.0; }
  /// Starting values for a response with that resonance and antiresonance [rad/s], inertia in all, damping ratio of the
  /// antiresonance, and corner of friction over inertia [rad/s].
  std::vector<double> values(double anti, double resonance, double inertia, double damping_ratio, double corner) const;

  bool current_ = false;
  bool load_ = false;
  bool speed_ = false;
  double torque_constant_ = 0.0;
  Timing timing_;
};

}  // namespace bodeflow::residual
