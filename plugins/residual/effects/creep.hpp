#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// Creep of a suspension: its stiffness grows with the logarithm of the frequency, k log10(s / w0) is added to it, w0 that of 1
/// Hz.
class Creep final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
