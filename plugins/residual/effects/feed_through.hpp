#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// The input reaches the output directly, beside the plant: a constant D is added to the response.
class FeedThrough final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  std::complex<double> transfer(const double* p, std::complex<double> s) const override;
};

}  // namespace bodeflow::residual
