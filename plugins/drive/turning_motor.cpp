#include "turning_motor.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "runge_kutta_parts.hpp"
#include "voltage_steps.hpp"

namespace bodeflow::drive {
namespace {

/// The inverse of the leakage, zero in the row and column of an iron loss, which has none.
LoopMatrix inverse_leakage(const MotorNetwork& network) {
  const Eigen::Index loops = network.loops() - (network.iron ? 1 : 0);
  LoopMatrix inverse = LoopMatrix::Zero(network.loops(), network.loops());
  inverse.topLeftCorner(loops, loops) = saturated_inductance(network, 0.0).topLeftCorner(loops, loops).inverse();
  return inverse;
}

}  // namespace

template <int kLoops>
TurningMotor<kLoops>::TurningMotor(const MotorNetwork& network, std::optional<MagnetisingCurve> curve, double fastest,
                                   const Mechanics& mechanics, double period_s)
    : network_(network),
      inverse_(curve ? inverse_leakage(network) : LoopMatrix(network.inductance.inverse())),
      resistance_(network.resistance),
      magnetises_(network.magnetises),
      pull_(inverse_ * magnetises_),
      stiffness_(magnetises_.dot(pull_)),
      curve_(std::move(curve)),
      fastest_(fastest),
      period_s_(period_s),
      mechanics_(mechanics),
      state_{Fluxes::Zero(), mechanics.locked ? 0.0 : mechanics.initial_speed, 0.0} {}

template <int kLoops>
void TurningMotor<kLoops>::advance(AlphaBeta voltage, double load_torque) {
  load_ = load_torque;
  interval(period_s_, voltage);
}

template <int kLoops>
void TurningMotor<kLoops>::advance(const std::array<Pulse, 3>& legs, double link, double load_torque) {
  load_ = load_torque;
  const VoltageSteps steps = voltage_steps(legs, link, period_s_);
  for (std::size_t k = 0; k < steps.count; ++k) interval(steps.length[k], steps.voltage[k]);
}

template <int kLoops>
void TurningMotor<kLoops>::interval(double length, AlphaBeta voltage) {
  voltage_ = {voltage.alpha - drop_.alpha, voltage.beta - drop_.beta};
  const double parts = runge_kutta_parts(length, fastest_ + mechanics_.pole_pairs * std::abs(state_.speed));
  if (!(parts >= 1.0)) {
    state_.speed = parts;
    return;
  }
  const double h = length / parts;
  for (double done = 0.0; done < parts; done += 1.0) {
    const State k1 = derivative(state_);
    const State k2 = derivative(moved(state_, 0.5 * h, k1));
    const State k3 = derivative(moved(state_, 0.5 * h, k2));
    const State k4 = derivative(moved(state_, h, k3));
    state_.flux += h / 6.0 * (k1.flux + 2.0 * (k2.flux + k3.flux) + k4.flux);
    state_.speed += h / 6.0 * (k1.speed + 2.0 * (k2.speed + k3.speed) + k4.speed);
    state_.position += h / 6.0 * (k1.position + 2.0 * (k2.position + k3.position) + k4.position);
  }
}

template <int kLoops>
typename TurningMotor<kLoops>::State TurningMotor<kLoops>::moved(const State& s, double h, const State& rate) {
  return {s.flux + h * rate.flux, s.speed + h * rate.speed, s.position + h * rate.position};
}

template <int kLoops>
typename TurningMotor<kLoops>::State TurningMotor<kLoops>::derivative(const State& s) const {
  const Fluxes x = currents(s.flux);
  State rate;
  rate.flux.noalias() = -(x * resistance_.asDiagonal());
  rate.flux.col(0) += voltage_;
  rate.speed = rate.position = 0.0;
  if (mechanics_.locked) return rate;
  const double omega = mechanics_.pole_pairs * s.speed;
  for (int k = 1; k <= network_.rotor_loops; ++k) {
    rate.flux(0, k) -= omega * s.flux(1, k);
    rate.flux(1, k) += omega * s.flux(0, k);
  }
  rate.speed = (torque(s.flux, x) - load_ - mechanics_.friction * s.speed) / mechanics_.inertia;
  rate.position = s.speed;
  return rate;
}

template <int kLoops>
typename TurningMotor<kLoops>::Fluxes TurningMotor<kLoops>::currents(const Fluxes& y) const {
  if (curve_) return saturated_currents(y);
  return y * inverse_;
}

template <int kLoops>
typename TurningMotor<kLoops>::Fluxes TurningMotor<kLoops>::saturated_currents(const Fluxes& y) const {
  Eigen::Vector2d magnetising, flux;
  if (network_.iron) {
    flux = -y.col(kLoops - 1);
    magnetising = curve_->current_share(flux.norm()) * flux;
  } else {
    const Eigen::Vector2d seen = y * pull_;
    magnetising = curve_->current_share(seen.norm()) * seen;
    flux = (seen - magnetising) / stiffness_;
  }
  Fluxes x = (y - flux * magnetises_.transpose()) * inverse_;
  if (network_.iron) x.col(kLoops - 1) = x.col(0) + x.col(1) - magnetising;
  return x;
}

template <int kLoops>
double TurningMotor<kLoops>::torque(const Fluxes& y, const Fluxes& x) const {
  double sum = 0.0;
  for (int k = 1; k <= network_.rotor_loops; ++k) sum += x(0, k) * y(1, k) - x(1, k) * y(0, k);
  return 1.5 * mechanics_.pole_pairs * sum;
}

template <int kLoops>
MotorOutputs TurningMotor<kLoops>::outputs() const {
  const Fluxes x = currents(state_.flux);
  return {{x(0, 0), x(1, 0)}, {state_.flux(0, 1), state_.flux(1, 1)}, torque(state_.flux, x), state_.speed, state_.position};
}

template <int kLoops>
MotorState TurningMotor<kLoops>::state() const {
  return {currents(state_.flux), state_.speed, state_.position};
}

template <int kLoops>
void TurningMotor<kLoops>::set_state(const MotorState& state) {
  Fluxes x = Fluxes::Zero();
  const Eigen::Index known = std::min<Eigen::Index>(kLoops, state.currents.cols());
  x.leftCols(known) = state.currents.leftCols(known);
  state_.speed = state.speed;
  state_.position = state.position;
  if (!curve_) {
    state_.flux = x * network_.inductance;
    return;
  }
  const Eigen::Vector2d magnetising = x * magnetises_;
  const double length = magnetising.norm();
  const double share = length > 0.0 ? curve_->flux(length) / length : 0.0;
  state_.flux = x * saturated_inductance(network_, 0.0) + share * magnetising * magnetises_.transpose();
}

template class TurningMotor<2>;
template class TurningMotor<3>;
template class TurningMotor<6>;
template class TurningMotor<7>;

}  // namespace bodeflow::drive
