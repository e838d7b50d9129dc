#pragma once

#include "clarke.hpp"
#include "motor.hpp"

namespace bodeflow::drive::simulated {

/// Speed control of an induction motor by indirect field orientation: PI for speed, PI for each axis of the current.
/// Reference: W. Leonhard, Control of Electrical Drives, 3rd ed., 2001, chapter 12.
class FieldOrientedControl {
 public:
  struct Setup {
    MotorParameters motor;
    double pole_pairs = 2.0;
    double inertia = 0.031;  ///< [kg m^2]
    double flux_vs = 0.9;    ///< of the rotor
    double largest_torque_nm = 18.0;
    double largest_voltage_v = 311.0;
    double current_bandwidth = 400.0;  ///< [rad/s]
    double speed_bandwidth = 40.0;     ///< [rad/s]
    double period_s = 250e-6;
  };

  explicit FieldOrientedControl(const Setup& setup);

  /// The voltage for the coming period, for what the motor shows at its start.
  AlphaBeta voltage(const MotorOutputs& motor, double speed_reference);
  void reset();

  /// Torque that the last reference of the current stands for [Nm].
  double torque() const { return torque_; }

 private:
  struct Axis {
    double integral = 0.0;
    double act(double error, double proportional, double integrating, double feed_forward, double most);
  };

  Setup s_;
  double sigma_, rotor_rate_, coupling_, torque_per_ampere_;
  Axis d_, q_;
  double speed_integral_ = 0.0;
  double angle_ = 0.0;  // of the rotor flux
  double torque_ = 0.0;
};

}  // namespace bodeflow::drive::simulated
