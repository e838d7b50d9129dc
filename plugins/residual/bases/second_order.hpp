#pragma once

#include <bodeflow/base_model.hpp>
#include <string>

namespace bodeflow::residual {

/// residual.second_order: m d2x/dt2 + c dx/dt + k x = u, a mass on a spring with a damper, or a resonant circuit.
class SecondOrder final : public BaseModel {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override;
  Timing timing() const override { return timing_; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;

 private:
  enum class Output { displacement, velocity, acceleration };
  struct Coefficients {
    double mass = 0.0, damping = 0.0, stiffness = 0.0;
  };

  Coefficients coefficients(const double* v) const;
  std::vector<double> values(const Coefficients& c) const;

  bool resonance_ = false;
  Output output_ = Output::displacement;
  std::string effort_unit_ = "N", displacement_unit_ = "m";
  Timing timing_;
};

}  // namespace bodeflow::residual
