#pragma once

#include <bodeflow/base_model.hpp>

namespace bodeflow::residual {

/// A black box without parameters of its own: a measured response from one or more inputs to one output, straight from line to
/// line in real and imaginary part, up to a gain of each input. Its noise is an error of the model.
class FrequencyResponseModel final : public BaseModel {
 public:
  static void describe(Describe& d);

  void configure(const Parameters& p) override;
  void use_model(const RecordView& record) override;
  std::vector<FitParameter> parameters() const override;
  std::vector<PlantInput> inputs() const override;
  Timing timing() const override { return timing_; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool has_state_space() const override { return false; }
  bool response(const double* v, const double* known, std::complex<double> s, std::complex<double>* matrix) const override;

 private:
  std::complex<double> value_at(std::size_t input, double frequency_hz) const;
  bool covers(double frequency_hz) const;

  std::string output_;
  std::vector<double> frequency_hz_;
  std::vector<std::vector<std::complex<double>>> response_;  ///< by inputs
  Timing timing_;
};

}  // namespace bodeflow::residual
