#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// The output comes late, y(t - d), by a time d beyond what is declared.
class Delay final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  double delay_s(const double* p) const override;
};

}  // namespace bodeflow::residual
