#pragma once

#include <bodeflow/parts.hpp>

/// Drag of a fluid: the force F = k v |v| against the velocity v of a bearing.
class Drag final : public bodeflow::Effect {
 public:
  static void describe(bodeflow::DescribeEffect& d);
  std::vector<bodeflow::FitParameter> parameters(const bodeflow::Situation& s) const override;
  std::vector<std::vector<double>> starts(const bodeflow::Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const bodeflow::Situation& s) const override;
  bodeflow::Reaction react(const double* p, const bodeflow::Signals& s, const double* memory, double* next) const override;
};
