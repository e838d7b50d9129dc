#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Friction of bending bristles (Canudas de Wit 1995, Olsson 1998): dz/dt = v - k |v| z / g(v), F = k z + d exp(-(v/w)^2)
/// dz/dt, g(v) = Fc (1 + r exp(-(v/w)^2)).
class LugreFriction final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override;
};

}  // namespace bodeflow::residual
