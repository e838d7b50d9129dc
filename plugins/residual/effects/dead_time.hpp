#pragma once

#include <bodeflow/effect.hpp>

namespace bodeflow::residual {

/// The dead time of an inverter, averaged over a PWM period: the voltage V s(i / (w + g V)) is lost, s the identity between
/// -1 and 1 and the sign beyond. V = (4/3) Vdc t_d f_pwm on the alpha axis with two legs in parallel; w stands for the
/// ripple, within which the current changes its sign inside a period, g V for the current that the lost voltage itself moves
/// in a step: so it stops the current and does not turn it around.
class DeadTime final : public Effect {
 public:
  static void describe(DescribeEffect& effect);

  std::vector<FitParameter> parameters(const Situation& s) const override;
  std::vector<std::vector<double>> starts(const Situation& s) const override;
  std::string sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const override;
  Reaction react(const double* p, const Signals& s, const double* memory, double* next) const override;
};

}  // namespace bodeflow::residual
