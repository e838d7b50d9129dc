#include "axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bodeflow::drive {
namespace {

constexpr double kLongestStep = 0.025;  // of 1 / (fastest rate): an error of 1e-10 a step
constexpr int kHalvings = 48;           // of a step that ends in another state
constexpr int kMostChanges = 40;        // in a sample; more: the torques are beyond what the axis is made for
const double kProgression = std::acosh(1.5);

int sign(double v) { return v > 0 ? 1 : (v < 0 ? -1 : 0); }

AxisState moved(const AxisState& x, double h, const AxisState& d) {
  return {x.motor_angle + h * d.motor_angle,
          x.motor_speed + h * d.motor_speed,
          x.load_angle + h * d.load_angle,
          x.load_speed + h * d.load_speed,
          x.work + h * d.work,
          x.heat + h * d.heat};
}

}  // namespace

Axis::Axis(const AxisParameters& parameters, const AxisPhysics& physics, double sample_s)
    : p_(parameters),
      h_(physics),
      motor_dry_(physics.motor_friction > 0 || physics.motor_stribeck > 0),
      load_dry_(physics.load_friction > 0 || physics.rub > 0),
      sample_s_(sample_s) {
  const double mobility = 1 / p_.motor_inertia + 1 / (p_.load_inertia * (1 - h_.turning_inertia));
  const double fastest = std::sqrt(p_.stiffness * mobility) + p_.damping * mobility + p_.motor_viscosity / p_.motor_inertia +
                         p_.load_viscosity / p_.load_inertia;
  step_s_ = sample_s / std::max(1.0, std::ceil(sample_s * fastest / kLongestStep));
  if (h_.progression_angle > 0) sinh_angle_ = h_.progression_angle / kProgression;
  set_state({});
}

void Axis::set_state(const AxisState& x) {
  x_ = x;
  touch_ = contact(x_);
  motor_ = motor_dry_ ? sign(x_.motor_speed) : 1;
  load_ = load_dry_ ? sign(x_.load_speed) : 1;
}

double Axis::spring(double e) const {
  return sinh_angle_ > 0 ? p_.stiffness * sinh_angle_ * std::sinh(e / sinh_angle_) : p_.stiffness * e;
}

double Axis::spring_energy(double e) const {
  if (sinh_angle_ > 0) return p_.stiffness * sinh_angle_ * sinh_angle_ * (std::cosh(e / sinh_angle_) - 1);
  return 0.5 * p_.stiffness * e * e;
}

/// The twist of the coupling's material, on the side on which it touches.
double Axis::stretch(const AxisState& x) const { return x.motor_angle - x.load_angle - touch_ * h_.backlash; }

double Axis::coupling_torque(const AxisState& x) const {
  if (is_free()) return 0.0;
  return spring(stretch(x)) + p_.damping * (x.motor_speed - x.load_speed);
}

/// The side on which the coupling touches: beyond the gap, and pushing.
int Axis::contact(const AxisState& x) const {
  if (!(h_.backlash > 0)) return 0;
  const double twist = x.motor_angle - x.load_angle, rate = x.motor_speed - x.load_speed;
  if (twist > h_.backlash && spring(twist - h_.backlash) + p_.damping * rate > 0) return 1;
  if (twist < -h_.backlash && spring(twist + h_.backlash) + p_.damping * rate < 0) return -1;
  return 0;
}

double Axis::load_inertia(double angle) const { return p_.load_inertia * (1 + h_.turning_inertia * std::cos(2 * angle)); }

double Axis::motor_friction(double speed) const {
  const double part = speed / h_.stribeck_speed;
  return h_.motor_friction + h_.motor_stribeck * (1 + (h_.breakaway - 1) * std::exp(-part * part));
}

double Axis::load_friction(double angle) const {
  if (h_.rub == 0) return h_.load_friction;
  const double off = std::remainder(angle, 2 * std::numbers::pi) / h_.rub_width;
  return h_.load_friction + (std::abs(off) < 1 ? h_.rub * 0.5 * (1 + std::cos(std::numbers::pi * off)) : 0.0);
}

/// The torques on a mass without dry friction.
double Axis::motor_push(const AxisState& x) const {
  const double cogging = h_.cogging == 0 ? 0.0 : h_.cogging * std::sin(h_.cogging_cycles * x.motor_angle);
  return torques_.motor - p_.motor_viscosity * x.motor_speed - coupling_torque(x) - cogging;
}

double Axis::load_push(const AxisState& x) const {
  const double slope = h_.turning_inertia == 0 ? 0.0 : -2 * p_.load_inertia * h_.turning_inertia * std::sin(2 * x.load_angle);
  return coupling_torque(x) - p_.load_viscosity * x.load_speed - 0.5 * slope * x.load_speed * x.load_speed - torques_.load;
}

AxisState Axis::derivative(const AxisState& x) const {
  AxisState d;
  const double motor_dry = motor_friction(x.motor_speed), load_dry = load_friction(x.load_angle);
  d.motor_angle = motor_ == 0 ? 0.0 : x.motor_speed;
  d.load_angle = load_ == 0 ? 0.0 : x.load_speed;
  d.motor_speed = motor_ == 0 ? 0.0 : (motor_push(x) - motor_ * motor_dry) / p_.motor_inertia;
  d.load_speed = load_ == 0 ? 0.0 : (load_push(x) - load_ * load_dry) / load_inertia(x.load_angle);
  const double rate = x.motor_speed - x.load_speed;
  d.work = torques_.motor * x.motor_speed - torques_.load * x.load_speed;
  d.heat = p_.motor_viscosity * x.motor_speed * x.motor_speed + p_.load_viscosity * x.load_speed * x.load_speed +
           motor_ * motor_dry * x.motor_speed + load_ * load_dry * x.load_speed + (is_free() ? 0.0 : p_.damping * rate * rate);
  return d;
}

AxisState Axis::stepped(double h) const {
  const AxisState k1 = derivative(x_);
  const AxisState k2 = derivative(moved(x_, 0.5 * h, k1));
  const AxisState k3 = derivative(moved(x_, 0.5 * h, k2));
  const AxisState k4 = derivative(moved(x_, h, k3));
  return moved(moved(moved(moved(x_, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
}

/// Whether both bearings and the coupling are at x still in the state in which they began the step.
bool Axis::same_state(const AxisState& x) const {
  if (contact(x) != touch_) return false;
  const bool motor = motor_ == 0 ? std::abs(motor_push(x)) <= motor_friction(0) : !motor_dry_ || motor_ * x.motor_speed >= 0;
  if (!motor) return false;
  return load_ == 0 ? std::abs(load_push(x)) <= load_friction(x.load_angle) : !load_dry_ || load_ * x.load_speed >= 0;
}

/// Goes to x, just behind a change of state, and takes up the new one.
void Axis::enter(const AxisState& x) {
  x_ = x;
  const double stored = is_free() ? 0.0 : spring_energy(stretch(x_));
  if (const int side = contact(x_); side != touch_) {
    touch_ = side;
    x_.heat += stored - (side == 0 ? 0.0 : spring_energy(stretch(x_)));
  }
  const auto bearing = [](int& direction, double& speed, double friction, auto push) {
    if (direction != 0 && direction * speed >= 0) return;
    if (friction == 0 && speed != 0) {
      direction = sign(speed);
      return;
    }
    speed = 0.0;
    direction = 0;
    if (const double torque = push(); std::abs(torque) > friction) direction = sign(torque);
  };
  if (motor_dry_) bearing(motor_, x_.motor_speed, motor_friction(0), [this] { return motor_push(x_); });
  if (load_dry_) bearing(load_, x_.load_speed, load_friction(x_.load_angle), [this] { return load_push(x_); });
}

void Axis::advance(AxisTorques torques) {
  torques_ = torques;
  if (!same_state(x_)) enter(x_);
  double left = sample_s_;
  for (int changes = 0; left > 0;) {
    double h = left < 1.5 * step_s_ ? left : step_s_;
    AxisState next = stepped(h);
    if (same_state(next)) {
      x_ = next;
      left -= h;
      continue;
    }
    double low = 0.0;
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (low + h);
      const AxisState there = stepped(middle);
      (same_state(there) ? low : h) = middle;
    }
    enter(stepped(h));
    left -= h;
    if (++changes > kMostChanges) {
      x_.motor_speed = std::numeric_limits<double>::quiet_NaN();
      return;
    }
  }
}

double Axis::energy() const {
  const double magnetic = h_.cogging == 0 ? 0.0 : -h_.cogging / h_.cogging_cycles * std::cos(h_.cogging_cycles * x_.motor_angle);
  return 0.5 * p_.motor_inertia * x_.motor_speed * x_.motor_speed +
         0.5 * load_inertia(x_.load_angle) * x_.load_speed * x_.load_speed + magnetic +
         (is_free() ? 0.0 : spring_energy(stretch(x_)));
}

}  // namespace bodeflow::drive
