#include "standstill_motor.hpp"

#include <cmath>

namespace bodeflow::drive {
namespace {

constexpr double kSeriesUpTo = 0.125;  // there ten terms of the series are exact to 2e-17

/// E(t) = (1 - e^(-p t)) / p.
double charge(double rate, double t) {
  const double x = rate * t;
  if (x > kSeriesUpTo) return -std::expm1(-x) / rate;
  const double inner = 1.0 - x / 8.0 * (1.0 - x / 9.0 * (1.0 - x / 10.0 * (1.0 - x / 11.0)));
  const double outer = 1.0 - x / 5.0 * (1.0 - x / 6.0 * (1.0 - x / 7.0 * inner));
  return t * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * outer)));
}

}  // namespace

StandstillMotor::StandstillMotor(const MotorNetwork& network, double pole_pairs, double period_s)
    : network_(network), pole_pairs_(pole_pairs), period_s_(period_s), modes_(static_cast<int>(network.loops())) {
  prepare();
}

void StandstillMotor::prepare() {
  const Modes modes = modes_of(network_.inductance, network_.resistance);
  vectors_ = modes.vectors;
  const LoopMatrix linkages = network_.inductance * vectors_;
  const LoopMatrix product =
      vectors_.middleRows(1, network_.rotor_loops).transpose() * linkages.middleRows(1, network_.rotor_loops);
  torque_ = 1.5 * pole_pairs_ * (product - product.transpose());
  for (int k = 0; k < modes_; ++k) {
    const auto at = static_cast<std::size_t>(k);
    rate_[at] = modes.rates[k];
    drive_[at] = vectors_(0, k);
    decay_[at] = std::exp(-modes.rates[k] * period_s_);
    full_[at] = drive_[at] * charge(modes.rates[k], period_s_);
    rotor_flux_[at] = linkages(1, k);
  }
}

void StandstillMotor::advance(AlphaBeta voltage, double) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(modes_); ++k) {
    alpha_[k] = decay_[k] * alpha_[k] + full_[k] * (voltage.alpha - drop_.alpha);
    beta_[k] = decay_[k] * beta_[k] + full_[k] * (voltage.beta - drop_.beta);
  }
}

void StandstillMotor::advance(const std::array<Pulse, 3>& legs, double link, double) {
  const bool same = legs[1].on == legs[2].on && legs[1].off == legs[2].off;
  for (std::size_t k = 0; k < static_cast<std::size_t>(modes_); ++k) {
    const auto given = [&](const Pulse& p) { return charge(rate_[k], period_s_ - p.on) - charge(rate_[k], period_s_ - p.off); };
    const double a = given(legs[0]), b = given(legs[1]), c = same ? b : given(legs[2]);
    const AlphaBeta v = clarke(a, b, c);
    alpha_[k] = decay_[k] * alpha_[k] + drive_[k] * link * v.alpha - full_[k] * drop_.alpha;
    beta_[k] = decay_[k] * beta_[k] + drive_[k] * link * v.beta - full_[k] * drop_.beta;
  }
}

MotorOutputs StandstillMotor::outputs() const {
  MotorOutputs y;
  for (std::size_t k = 0; k < static_cast<std::size_t>(modes_); ++k) {
    y.current.alpha += drive_[k] * alpha_[k];
    y.current.beta += drive_[k] * beta_[k];
    y.flux.alpha += rotor_flux_[k] * alpha_[k];
    y.flux.beta += rotor_flux_[k] * beta_[k];
  }
  y.torque = torque();
  return y;
}

double StandstillMotor::torque() const {
  double sum = 0.0;
  for (int j = 0; j < modes_; ++j) {
    const auto first = static_cast<std::size_t>(j);
    for (int k = j + 1; k < modes_; ++k) {
      const auto second = static_cast<std::size_t>(k);
      sum += torque_(j, k) * (alpha_[first] * beta_[second] - alpha_[second] * beta_[first]);
    }
  }
  return sum;
}

MotorState StandstillMotor::state() const {
  MotorState s;
  s.currents.resize(2, modes_);
  const LoopVector alpha = Eigen::Map<const Eigen::VectorXd>(alpha_.data(), modes_);
  const LoopVector beta = Eigen::Map<const Eigen::VectorXd>(beta_.data(), modes_);
  s.currents.row(0) = (vectors_ * alpha).transpose();
  s.currents.row(1) = (vectors_ * beta).transpose();
  return s;
}

void StandstillMotor::set_state(const MotorState& state) {
  LoopCurrents x = LoopCurrents::Zero(2, modes_);
  const Eigen::Index known = std::min<Eigen::Index>(modes_, state.currents.cols());
  x.leftCols(known) = state.currents.leftCols(known);
  const LoopCurrents z = x * network_.inductance * vectors_;
  for (int k = 0; k < modes_; ++k) {
    alpha_[static_cast<std::size_t>(k)] = z(0, k);
    beta_[static_cast<std::size_t>(k)] = z(1, k);
  }
}

void StandstillMotor::set_stator_resistance(double ohm) {
  const MotorState kept = state();
  network_.resistance[0] = ohm;
  prepare();
  set_state(kept);
}

}  // namespace bodeflow::drive
