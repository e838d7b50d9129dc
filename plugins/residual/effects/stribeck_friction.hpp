#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Dry friction that is greater when it starts: F (1 + r exp(-(v / w)^2)) against the movement.
class StribeckFriction final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override;
};

}  // namespace bodeflow::residual
