#pragma once

#include <array>
#include <cstdint>

namespace bodeflow::drive {

/// Motor and load with an elastic coupling between them.
struct AxisParameters {
  double motor_inertia = 1e-3;    ///< [kg m^2]
  double load_inertia = 2e-3;     ///< [kg m^2]
  double stiffness = 40.0;        ///< of the coupling [Nm/rad]
  double damping = 0.02;          ///< in the coupling [Nm s/rad]
  double motor_viscosity = 0.01;  ///< [Nm s/rad]
  double load_viscosity = 0.01;   ///< [Nm s/rad]
};

/// What a real axis does beside. 0 switches an effect off.
struct AxisPhysics {
  double motor_friction = 0.0;     ///< dry, the same at every speed [Nm]
  double motor_stribeck = 0.0;     ///< dry, at high speed [Nm]; `breakaway` times as much at rest
  double breakaway = 1.6;          ///< at least 1
  double stribeck_speed = 0.5;     ///< at which 1/e of that rise is left [rad/s]
  double load_friction = 0.0;      ///< dry [Nm]
  double backlash = 0.0;           ///< half of the gap in the coupling [rad]
  double progression_angle = 0.0;  ///< twist at which the coupling's stiffness is 1.5 times that at rest [rad]
  double cogging = 0.0;            ///< peak [Nm] of the torque between magnets and teeth
  double cogging_cycles = 24.0;    ///< a turn
  double turning_inertia = 0.0;    ///< the load's inertia is load_inertia (1 + turning_inertia cos 2 angle); below 1
  double rub = 0.0;                ///< dry friction [Nm] of the load within rub_width of the angle 0, once a turn
  double rub_width = 0.4;          ///< [rad]
};

/// Torques: what the motor gives, and what acts on the load against the rotation.
struct AxisTorques {
  double motor = 0.0, load = 0.0;
};

/// State: angles [rad, not wrapped], speeds [rad/s], work put in and heat made [J] since the beginning.
struct AxisState {
  double motor_angle = 0.0, motor_speed = 0.0, load_angle = 0.0, load_speed = 0.0, work = 0.0, heat = 0.0;
};

/// A two-mass axis with dry friction that really sticks and a coupling with play, stepped from sample to sample.
///
///   Jm dwm/dt = T - dm wm - Tc - cogging sin(cycles am) - friction(wm)
///   Jl dwl/dt = Tc - dl wl - dJl/dangle wl^2 / 2 - Tl - friction(wl, al)
///   Tc = spring(e) + c (wm - wl) where the coupling touches, e = am - al -+ backlash; it pushes and never pulls, so it lets go
///   when Tc passes 0. spring(e) = k e, or k e0 sinh(e / e0) with e0 = progression_angle / arcosh 1.5.
///
/// A bearing is in one of three states: it slides one way or the other, or it sticks as long as the torque on it stays within
/// the friction at rest. Between changes of state the equations are smooth: the classical Runge-Kutta method of order 4. A step
/// that ends in another state is cut by bisection where the change is, so no sign function is smoothed.
class Axis {
 public:
  Axis(const AxisParameters& parameters, const AxisPhysics& physics, double sample_s);

  /// Steps of its integrator in a sample, at least: they follow from the fastest rate.
  double steps_per_sample() const { return sample_s_ / step_s_; }
  /// One sample with constant torques. A state that is not finite: an axis beyond all numbers.
  void advance(AxisTorques torques);
  const AxisState& state() const { return x_; }
  void set_state(const AxisState& x);
  /// Kinetic, elastic and magnetic energy [J]. energy() - work + heat is constant.
  double energy() const;
  bool motor_sticks() const { return motor_ == 0; }
  bool load_sticks() const { return load_ == 0; }

 private:
  double coupling_torque(const AxisState& x) const;
  double spring(double e) const;
  double spring_energy(double e) const;
  double stretch(const AxisState& x) const;
  double load_inertia(double angle) const;
  double motor_push(const AxisState& x) const;
  double load_push(const AxisState& x) const;
  double motor_friction(double speed) const;
  double load_friction(double angle) const;
  int contact(const AxisState& x) const;
  AxisState derivative(const AxisState& x) const;
  AxisState stepped(double h) const;
  bool is_free() const { return h_.backlash > 0 && touch_ == 0; }
  bool same_state(const AxisState& x) const;
  void enter(const AxisState& x);

  AxisParameters p_;
  AxisPhysics h_;
  bool motor_dry_, load_dry_;  // friction that may hold a mass
  double sample_s_, step_s_ = 0.0;
  double sinh_angle_ = 0.0;  // e0
  AxisState x_;
  AxisTorques torques_;
  int motor_ = 0, load_ = 0;  // direction of sliding; 0: sticks
  int touch_ = 0;             // side on which the coupling touches; 0: neither
};

}  // namespace bodeflow::drive
