#include "five_state_motor.hpp"

#include <cmath>

#include "runge_kutta_parts.hpp"
#include "voltage_steps.hpp"

namespace bodeflow::drive {

FiveStateMotor::FiveStateMotor(const MotorParameters& p, double fastest, const Mechanics& mechanics, double period_s)
    : lm_(p.lm),
      lr_(p.lr),
      coupling_(p.lm / p.lr),
      sigma_(p.ls - p.lm * p.lm / p.lr),
      rotor_rate_(p.rr / p.lr * (1.0 + p.lm * coupling_ / sigma_)),
      rotor_gain_(p.rr / p.lr * p.lm / sigma_),
      torque_gain_(1.5 * mechanics.pole_pairs * coupling_ / sigma_),
      per_inertia_(1.0 / mechanics.inertia),
      friction_(mechanics.friction),
      pairs_(mechanics.pole_pairs),
      fastest_(fastest),
      period_s_(period_s) {
  state_.speed = mechanics.initial_speed;
  set_stator_resistance(p.rs);
}

void FiveStateMotor::set_stator_resistance(double ohm) { stator_rate_ = ohm / sigma_; }

inline FiveStateMotor::State FiveStateMotor::derivative(const State& s, AlphaBeta v, double load) const {
  const double omega = pairs_ * s.speed;
  State d;
  d.ya = v.alpha - stator_rate_ * (s.ya - coupling_ * s.pa);
  d.yb = v.beta - stator_rate_ * (s.yb - coupling_ * s.pb);
  d.pa = (rotor_gain_ * s.ya - rotor_rate_ * s.pa) - omega * s.pb;
  d.pb = (rotor_gain_ * s.yb - rotor_rate_ * s.pb) + omega * s.pa;
  d.speed = per_inertia_ * (torque_gain_ * (s.pa * s.yb - s.pb * s.ya) - (load + friction_ * s.speed));
  return d;
}

void FiveStateMotor::interval(double length, AlphaBeta v, double load) {
  const double parts = runge_kutta_parts(length, fastest_ + pairs_ * std::abs(state_.speed));
  if (!(parts >= 1.0)) {
    state_.speed = parts;
    return;
  }
  const double h = length / parts;
  const auto moved = [&s = state_](double by, const State& d) {
    return State{s.ya + by * d.ya, s.yb + by * d.yb, s.pa + by * d.pa, s.pb + by * d.pb, s.speed + by * d.speed};
  };
  for (double done = 0.0; done < parts; done += 1.0) {
    const State k1 = derivative(state_, v, load);
    const State k2 = derivative(moved(0.5 * h, k1), v, load);
    const State k3 = derivative(moved(0.5 * h, k2), v, load);
    const State k4 = derivative(moved(h, k3), v, load);
    const auto mean = [&](double State::*m) { return (k1.*m + k4.*m) + 2.0 * (k2.*m + k3.*m); };
    position_ += h * (state_.speed + h / 6.0 * (k1.speed + k2.speed + k3.speed));
    state_ = moved(h / 6.0, {mean(&State::ya), mean(&State::yb), mean(&State::pa), mean(&State::pb), mean(&State::speed)});
  }
}

void FiveStateMotor::advance(AlphaBeta voltage, double load_torque) {
  interval(period_s_, {voltage.alpha - drop_.alpha, voltage.beta - drop_.beta}, load_torque);
}

void FiveStateMotor::advance(const std::array<Pulse, 3>& legs, double link, double load_torque) {
  const VoltageSteps steps = voltage_steps(legs, link, period_s_);
  for (std::size_t k = 0; k < steps.count; ++k) {
    const AlphaBeta v{steps.voltage[k].alpha - drop_.alpha, steps.voltage[k].beta - drop_.beta};
    interval(steps.length[k], v, load_torque);
  }
}

MotorOutputs FiveStateMotor::outputs() const {
  const State& s = state_;
  return {{(s.ya - coupling_ * s.pa) / sigma_, (s.yb - coupling_ * s.pb) / sigma_},
          {s.pa, s.pb},
          torque_gain_ * (s.pa * s.yb - s.pb * s.ya),
          s.speed,
          position_};
}

MotorState FiveStateMotor::state() const {
  const MotorOutputs y = outputs();
  MotorState state{LoopCurrents(2, 2), y.speed, y.position};
  state.currents << y.current.alpha, (y.flux.alpha - lm_ * y.current.alpha) / lr_,  //
      y.current.beta, (y.flux.beta - lm_ * y.current.beta) / lr_;
  return state;
}

void FiveStateMotor::set_state(const MotorState& state) {
  const LoopCurrents& x = state.currents;
  state_.pa = lm_ * x(0, 0) + lr_ * x(0, 1);
  state_.pb = lm_ * x(1, 0) + lr_ * x(1, 1);
  state_.ya = sigma_ * x(0, 0) + coupling_ * state_.pa;
  state_.yb = sigma_ * x(1, 0) + coupling_ * state_.pb;
  state_.speed = state.speed;
  position_ = state.position;
}

}  // namespace bodeflow::drive
