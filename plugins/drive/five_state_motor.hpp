#pragma once

#include "motor.hpp"

namespace bodeflow::drive {

/// The linear motor that turns, without hidden loops: model (16) with five states, by the classical Runge-Kutta method of order 4
/// from one switching instant to the next. In the coordinates (stator flux y, rotor flux psi, speed) with k = Lm / Lr:
///   sigma i = y - k psi,  dy/dt = v - Rs i,  dpsi/dt = -alpha psi + alpha Lm i + omega J psi,
///   inertia dspeed/dt = 3/2 pole_pairs k / sigma (psi cross y) - load - friction speed.
/// Steps are split as those of TurningMotor, which is the same method for any number of loops.
class FiveStateMotor final : public Motor {
 public:
  FiveStateMotor(const MotorParameters& p, double fastest, const Mechanics& mechanics, double period_s);

  void advance(AlphaBeta voltage, double load_torque) override;
  void advance(const std::array<Pulse, 3>& legs, double link, double load_torque) override;
  MotorOutputs outputs() const override;
  MotorState state() const override;
  void set_state(const MotorState& state) override;
  void set_stator_resistance(double ohm) override;

 private:
  struct State {
    double ya = 0.0, yb = 0.0, pa = 0.0, pb = 0.0, speed = 0.0;
  };

  State derivative(const State& s, AlphaBeta v, double load) const;
  void interval(double length, AlphaBeta v, double load);

  double lm_, lr_, coupling_, sigma_;  // coupling: Lm / Lr
  double stator_rate_ = 0.0;           // Rs / sigma
  double rotor_rate_, rotor_gain_;     // alpha + alpha Lm k / sigma, alpha Lm / sigma
  double torque_gain_, per_inertia_, friction_, pairs_;
  double fastest_, period_s_;
  State state_;
  double position_ = 0.0;
};

}  // namespace bodeflow::drive
