#include "model/sampled_plant.hpp"

#include <numbers>

#include "model/transition.hpp"

namespace bodeflow::residual {

SampledPlant::SampledPlant(const PlantMatrices& p, const std::optional<Modes>& modes, bool straight, double sample_time_s,
                           double delay_s, int values_per_sample)
    : straight_(straight), hold_s_(sample_time_s / values_per_sample) {
  const SampleDelay delay = sample_delay(delay_s, hold_s_);
  late_ = delay.late;
  const Transition whole = transition(p.A, hold_s_), part = transition(p.A, delay.offset_s);
  std::optional<Modes> stepped = modes;
  if (stepped) stepped->poles = (modes->poles * hold_s_).array().exp();
  const Eigen::RowVectorXd by_state = p.C * part.phi;
  Eigen::MatrixXd begin = whole.psi[0] * p.B;
  by_begin_ = p.C * part.psi[0] * p.B + p.D;
  if (straight) {
    const Eigen::MatrixXd end = whole.psi[1] * p.B / hold_s_;
    begin -= end;
    from_end_ = Resolvent(whole.phi, stepped, end, by_state);
    by_end_ = p.C * part.psi[1] * p.B / hold_s_ + delay.offset_s / hold_s_ * p.D;
    by_begin_ -= by_end_;
  }
  from_begin_ = Resolvent(whole.phi, stepped, begin, by_state);
}

Eigen::RowVectorXcd SampledPlant::at(double frequency_hz) const {
  const double angle = 2.0 * std::numbers::pi * frequency_hz * hold_s_;
  const std::complex<double> z = std::polar(1.0, angle);
  Eigen::MatrixXcd sum;
  from_begin_.at(z, sum);
  sum += by_begin_.cast<std::complex<double>>();
  if (straight_) {
    Eigen::MatrixXcd more;
    from_end_.at(z, more);
    sum += z * (more + by_end_.cast<std::complex<double>>());
  }
  return sum.row(0) * std::polar(1.0, -angle * static_cast<double>(late_));
}

}  // namespace bodeflow::residual
