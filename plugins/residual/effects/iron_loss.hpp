#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Losses in the iron of a core: a resistance beside the magnetising inductance takes the current G v.
class IronLoss final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
