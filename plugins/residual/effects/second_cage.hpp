#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// A second cage of the rotor: a branch of R parallel to L in series with the first, less the inductance L that is seen at low
/// frequencies: -k s^2 / (1 + s T) with T = L / R and k = R T^2.
class SecondCage final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
