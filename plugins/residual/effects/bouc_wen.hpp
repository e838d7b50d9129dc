#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Hysteresis (Bouc 1967, Wen 1976) beside the linear spring: the force k X z, X dz/dx = 1 - |z| towards the limit, 1 + m |z|
/// back from it: Wen's law with n = 1, m = (beta - gamma) / (beta + gamma).
class BoucWen final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override;
};

}  // namespace bodeflow::residual
