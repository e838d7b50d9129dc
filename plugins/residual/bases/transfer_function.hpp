#pragma once

#include <bodeflow/base_model.hpp>

namespace bodeflow::residual {

/// A black box of declared orders, one input and one output, stable: N(x) / D(x) with x = s / (2 pi reference_frequency), N(x) =
/// b0 + b1 x + ... + bm x^m, D(x) the product of sections x^2 + p x + q and, for an odd order, one x + r; p, q, r > 0.
class TransferFunctionModel final : public BaseModel {
 public:
  static void describe(Describe& d);

  void configure(const Parameters& p) override;
  std::vector<FitParameter> parameters() const override;
  Timing timing() const override { return timing_; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;
  bool response(const double* v, const double* known, std::complex<double> s, std::complex<double>* matrix) const override;

 private:
  std::vector<double> denominator(const double* v) const;  ///< ascending powers of x, monic
  double unit() const;                                     ///< rad/s of x = 1

  int order_ = 2, numerator_order_ = 0;
  double reference_hz_ = 1.0, magnitude_ = 1.0;
  Timing timing_;
};

}  // namespace bodeflow::residual
