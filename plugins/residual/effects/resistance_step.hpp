#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// A winding whose resistance jumps at an instant: from then on the voltage r i is lost in addition.
class ResistanceStep final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override;
};

}  // namespace bodeflow::residual
