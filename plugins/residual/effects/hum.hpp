#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Mains hum: a tone near 50 or 60 Hz and its third harmonic in the output, amplitudes and phases free in every record.
class Hum final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::vector<double> tones_hz(const double* p) const override;
  std::string refuses(const Situation& s) const override;
};

}  // namespace bodeflow::residual
