#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Iron that saturates: beyond the linear magnetising current flows psi (a psi^2 + b psi^4) / (1 + c psi^4), psi the flux
/// linkage, all of a, b, c positive: third and fifth power at first, straight again far beyond the knee.
class Saturation final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override;
};

}  // namespace bodeflow::residual
