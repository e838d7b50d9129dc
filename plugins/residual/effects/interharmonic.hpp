#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// A tone of any frequency in the output that the input does not make, amplitude and phase free in every record.
class Interharmonic final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::vector<double> tones_hz(const double* p) const override;
  std::string refuses(const Situation& s) const override;
};

}  // namespace bodeflow::residual
