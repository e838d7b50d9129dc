#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// An actuator that gives no more than its limit: u between -c and c.
class InputClipping final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  double map(const double* p, double x, double time_s, double* memory) const override;
};

}  // namespace bodeflow::residual
