#pragma once

#include <bodeflow/base_model.hpp>

namespace bodeflow::residual {

/// A black box from a record `model`: continuous-time matrices A, B, C, D with one output, or numerator and denominator. What was
/// identified stays as it is, up to a gain of each input: its errors are errors of the model, and what an effect that it lacked
/// has pushed into its coefficients stays there.
class StateSpaceModel final : public BaseModel {
 public:
  static void describe(Describe& d);

  void configure(const Parameters& p) override;
  void use_model(const RecordView& record) override;
  std::vector<FitParameter> parameters() const override;
  std::vector<PlantInput> inputs() const override;
  Timing timing() const override;
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;

 private:
  LinearPlant plant_;
  std::string method_;
  Timing timing_;
  double model_delay_s_ = 0.0;
};

}  // namespace bodeflow::residual
