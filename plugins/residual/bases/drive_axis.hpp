#pragma once

#include <bodeflow/base_model.hpp>
#include <string>

namespace bodeflow::residual {

/// residual.drive_axis: M dv/dt + F v = f u, an axis that a motor of known force constant f moves against viscous friction; or
/// the same turned round, from the measured position to the force.
class DriveAxis final : public BaseModel {
 public:
  static void describe(Describe& d);
  void configure(const Parameters& p) override;

  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override;
  std::vector<PlantInput> inputs() const override;
  double filter_hz() const override { return inverse_ ? filter_hz_ : 0.0; }
  Timing timing() const override { return timing_; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;

 private:
  bool rotary_ = false;
  bool inverse_ = false;
  bool velocity_ = false;
  double force_constant_ = 1.0;
  double filter_hz_ = 0.0;
  Timing timing_;
};

}  // namespace bodeflow::residual
