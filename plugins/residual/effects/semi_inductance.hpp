#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// The impedance of a coil on solid iron, whose eddy currents push the field into a skin: X (s / w0)^n with 0 < n < 1, w0 that of
/// 1 kHz; n = 1/2 for a thick linear iron.
class SemiInductance final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
