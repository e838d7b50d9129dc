#pragma once

#include "effect.hpp"

namespace bodeflow::residual {

/// The dead time of an inverter, averaged over a PWM period: the voltage V s(i / (w + g V)) is lost, i the current at the start
/// of the period, s the identity between -1 and 1 and the sign beyond. V = (4/3) Vdc t_d f_pwm on the alpha axis with two legs in
/// parallel; w stands for the ripple, within which the current changes its sign inside a period, g V for the least current that
/// the lost voltage itself moves in a period: below it the current is stopped, as it is by a real dead time. Reference: S.-G.
/// Jeong, M.-H. Park, The analysis and compensation of dead-time effects in PWM inverters, IEEE Trans. Industrial Electronics 38
/// (1991) 108.
class DeadTime final : public Effect {
 public:
  std::string name() const override { return "dead_time"; }
  std::vector<Parameter> parameters() const override;
  std::vector<Eigen::VectorXd> starts(const Scales& scales) const override;
  std::string sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales& scales) const override;
  bool linear() const override { return false; }
  int steps_per_sample() const override { return 10; }
  double effort_lost(const double* p, double current, double gain) const override;
};

}  // namespace bodeflow::residual
