#include <array>
#include <cmath>

#include "catch.hpp"
#include "drive/motor.hpp"

using namespace bodeflow::drive;

namespace {

constexpr MotorParameters kTable1{6.6, 5.5, 0.475, 0.475, 0.454};
constexpr double kPeriod = 1e-4;

/// Model (16) of Castaldi, Montanari, Tilli 2002 as printed, states psi_a, psi_b, i_a, i_b, omega (electrical), with what the
/// print leaves out: mu at the torque, and the pole pairs p, by which J domega/dt = p (p mu (psi_a i_b - psi_b i_a) - T_L).
struct Equation16 {
  double rs, rr, ls, lr, lm, pole_pairs, inertia;

  using State = std::array<double, 5>;

  State operator()(const State& x, double va, double vb, double load) const {
    const double sigma = ls * (1 - lm * lm / (ls * lr)), beta = lm / (sigma * lr), alpha = rr / lr;
    const double gamma = rs / sigma + alpha * lm * beta, mu = 3 * lm / (2 * lr);
    const auto [psi_a, psi_b, ia, ib, w] = x;
    return {-alpha * psi_a - w * psi_b + alpha * lm * ia, -alpha * psi_b + w * psi_a + alpha * lm * ib,
            -gamma * ia + alpha * beta * psi_a + beta * w * psi_b + va / sigma,
            -gamma * ib + alpha * beta * psi_b - beta * w * psi_a + vb / sigma,
            pole_pairs / inertia * (pole_pairs * mu * (psi_a * ib - psi_b * ia) - load)};
  }

  /// One PWM period with constant voltage in `steps` Heun steps: order 2, so an error falls by 4 where the steps double.
  State period(State x, double va, double vb, double load, int steps) const {
    const double h = kPeriod / steps;
    for (int k = 0; k < steps; ++k) {
      const State first = (*this)(x, va, vb, load);
      State ahead = x;
      for (std::size_t s = 0; s < x.size(); ++s) ahead[s] += h * first[s];
      const State second = (*this)(ahead, va, vb, load);
      for (std::size_t s = 0; s < x.size(); ++s) x[s] += h / 2 * (first[s] + second[s]);
    }
    return x;
  }
};

std::unique_ptr<Motor> motor(double pole_pairs, double inertia, bool locked, const HiddenPhysics& hidden = {}) {
  auto made = make_motor({kTable1, hidden, {pole_pairs, inertia, 0.0, 0.0, locked}, kPeriod});
  REQUIRE(made);
  return std::move(*made);
}

struct Difference {
  double current = 0, flux = 0, speed = 0, torque = 0;
};

/// The largest differences between motor and equation over a start against a load, from 220 V peak at 50 Hz.
Difference start(Motor& m, double pole_pairs, double inertia, bool locked, int steps) {
  const Equation16 equation{kTable1.rs, kTable1.rr, kTable1.ls, kTable1.lr, kTable1.lm, pole_pairs, locked ? 1e30 : inertia};
  Equation16::State x{};
  Difference d;
  for (int n = 0; n < 2500; ++n) {
    const double angle = 2 * M_PI * 50 * n * kPeriod, load = n < 1500 ? 0.0 : 2.5;
    const double va = 220 * std::cos(angle), vb = 220 * std::sin(angle);
    m.advance({va, vb}, load);
    x = equation.period(x, va, vb, load, steps);
    const MotorOutputs y = m.outputs();
    const double mu = 3 * kTable1.lm / (2 * kTable1.lr);
    d.current = std::max(d.current, std::hypot(y.current.alpha - x[2], y.current.beta - x[3]));
    d.flux = std::max(d.flux, std::hypot(y.flux.alpha - x[0], y.flux.beta - x[1]));
    d.speed = std::max(d.speed, std::abs(y.speed - x[4] / pole_pairs));
    d.torque = std::max(d.torque, std::abs(y.torque - pole_pairs * mu * (x[0] * x[3] - x[1] * x[2])));
  }
  return d;
}

}  // namespace

TEST_CASE("motor: a start against a load follows equation (16) integrated on its own, with pole pairs and mu") {
  for (const double pole_pairs : {1.0, 2.0}) {
    const auto turning = motor(pole_pairs, 0.003, false);
    const Difference d = start(*turning, pole_pairs, 0.003, false, 100);
    INFO(pole_pairs << " pole pairs: " << d.current << " A, " << d.flux << " Vs, " << d.speed << " rad/s, " << d.torque << " Nm");
    // Currents reach 13 A, speeds 300 rad/s.
    CHECK(d.current < 2e-5);
    CHECK(d.flux < 2e-6);
    CHECK(d.speed < 1e-3);
    CHECK(d.torque < 1e-4);
  }
}

TEST_CASE("motor: with the rotor locked both axes follow equation (16), exact solution and Runge-Kutta alike") {
  const auto exact = motor(1, 0, true);
  const Difference d = start(*exact, 1, 0, true, 100);
  INFO(d.current << " A, " << d.flux << " Vs, " << d.torque << " Nm");
  CHECK(d.current < 1e-5);
  CHECK(d.torque < 1e-4);
  // A curve that does not bend takes the other way through the code.
  HiddenPhysics straight;
  straight.saturation_current = 1e5;
  const auto stepped = motor(1, 0, true, straight);
  const Difference s = start(*stepped, 1, 0, true, 100);
  INFO(s.current << " A, " << s.flux << " Vs, " << s.torque << " Nm");
  CHECK(s.current < 1e-5);
  CHECK(s.torque < 1e-4);
}

TEST_CASE("motor: switching and its mean voltage differ by the ripple alone, which is zero at the start of a period") {
  const auto switched = motor(2, 0.003, false), averaged = motor(2, 0.003, false);
  double largest = 0, current = 0;
  for (int n = 0; n < 1500; ++n) {
    const double angle = 2 * M_PI * 30 * n * kPeriod;
    const Switching s = switching({kPeriod, 540.0, 0, 0, false}, {150 * std::cos(angle), 150 * std::sin(angle)}, {}, {});
    switched->advance(s.legs, 540, 0);
    averaged->advance(s.mean_voltage, 0);
    const AlphaBeta a = switched->outputs().current, b = averaged->outputs().current;
    largest = std::max(largest, std::hypot(a.alpha - b.alpha, a.beta - b.beta));
    current = std::max(current, std::hypot(b.alpha, b.beta));
  }
  INFO(largest << " A of " << current << " A");
  CHECK(largest < 1e-3 * current);
}
