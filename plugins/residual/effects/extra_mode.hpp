#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// One more resonance beside the plant: w (2 zeta) (b s - a w) / (s^2 + 2 zeta w s + w^2), whose value at the resonance is b + j
/// a.
class ExtraMode final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
