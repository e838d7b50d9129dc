#include "field_oriented_control.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bodeflow::drive::simulated {

FieldOrientedControl::FieldOrientedControl(const Setup& setup) : s_(setup) {
  const ModelConstants c = constants_of(s_.motor);
  sigma_ = c.sigma;
  rotor_rate_ = c.alpha;
  coupling_ = s_.motor.lm / s_.motor.lr;
  torque_per_ampere_ = torque_constant(s_.motor) * s_.pole_pairs * s_.flux_vs;
}

void FieldOrientedControl::reset() {
  d_ = q_ = {};
  speed_integral_ = angle_ = torque_ = 0.0;
}

/// A PI controller whose integral stands still while its output is at the limit.
double FieldOrientedControl::Axis::act(double error, double proportional, double integrating, double feed_forward, double most) {
  const double free = proportional * error + integral + feed_forward;
  const double limited = std::clamp(free, -most, most);
  const bool windup = (free > most && error > 0.0) || (free < -most && error < 0.0);
  if (!windup) integral += integrating * error;
  return limited;
}

AlphaBeta FieldOrientedControl::voltage(const MotorOutputs& motor, double speed_reference) {
  // The torque's reference from the error of the speed; the ratio of 4 between both corners leaves a phase margin of 62 degrees.
  const double error = speed_reference - motor.speed;
  const double gain = s_.inertia * s_.speed_bandwidth;
  const double wanted = gain * error + speed_integral_;
  torque_ = std::clamp(wanted, -s_.largest_torque_nm, s_.largest_torque_nm);
  if (std::abs(wanted) < s_.largest_torque_nm || wanted * error < 0.0) {
    speed_integral_ += gain * s_.speed_bandwidth / 4.0 * s_.period_s * error;
  }
  const double id_wanted = s_.flux_vs / s_.motor.lm, iq_wanted = torque_ / torque_per_ampere_;

  const double cosine = std::cos(angle_), sine = std::sin(angle_);
  const double id = cosine * motor.current.alpha + sine * motor.current.beta;
  const double iq = cosine * motor.current.beta - sine * motor.current.alpha;
  const double omega = s_.pole_pairs * motor.speed + rotor_rate_ * iq_wanted / id_wanted;

  const double proportional = sigma_ * s_.current_bandwidth;
  const double resistance = s_.motor.rs + s_.motor.rr * coupling_ * coupling_;
  const double integrating = resistance * s_.current_bandwidth * s_.period_s;
  const double vd = d_.act(id_wanted - id, proportional, integrating, -omega * sigma_ * iq, s_.largest_voltage_v);
  const double left = std::sqrt(std::max(s_.largest_voltage_v * s_.largest_voltage_v - vd * vd, 0.0));
  const double vq = q_.act(iq_wanted - iq, proportional, integrating, omega * (sigma_ * id + coupling_ * s_.flux_vs), left);

  const double middle = angle_ + 0.5 * omega * s_.period_s;  // where the field is on average in the period
  angle_ = std::remainder(angle_ + omega * s_.period_s, 2.0 * std::numbers::pi);
  return {std::cos(middle) * vd - std::sin(middle) * vq, std::sin(middle) * vd + std::cos(middle) * vq};
}

}  // namespace bodeflow::drive::simulated
