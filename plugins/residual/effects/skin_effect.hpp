#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Skin effect in bars: the field diffuses into them in the time T, and the resistance R of the bars becomes R x coth x with
/// x^2 = s T. What is added is R (x coth x - 1 - x^2 / 3), for the base model has the resistance and the slot leakage that are
/// seen at low frequencies; there it is -k s^2, k = R T^2 / 45: a resistance that rises with the square of the frequency.
class SkinEffect final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
