#pragma once

#include "motor.hpp"

namespace bodeflow::drive {

/// A linear motor whose rotor stands still, exact for any switching: each mode of the passive network is a first-order lag,
///   z(T) = e^(-p T) z(0) + w sum_pulses V (E(T - on) - E(T - off)), E(t) = (1 - e^(-p t)) / p,
/// so a period costs one E for each edge and mode, whatever their order. The error is rounding alone.
class StandstillMotor final : public Motor {
 public:
  StandstillMotor(const MotorNetwork& network, double pole_pairs, double period_s);

  void advance(AlphaBeta voltage, double load_torque) override;
  void advance(const std::array<Pulse, 3>& legs, double link, double load_torque) override;
  MotorOutputs outputs() const override;
  MotorState state() const override;
  void set_state(const MotorState& state) override;
  void set_stator_resistance(double ohm) override;

 private:
  void prepare();
  double torque() const;

  MotorNetwork network_;
  double pole_pairs_;
  double period_s_;
  int modes_ = 0;
  std::array<double, kMostLoops> rate_{}, drive_{}, decay_{}, full_{}, rotor_flux_{};
  LoopMatrix vectors_;
  LoopMatrix torque_;  // between mode j of alpha and mode k of beta
  std::array<double, kMostLoops> alpha_{}, beta_{};
};

}  // namespace bodeflow::drive
