#include "drive/axis.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>

#include "catch.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;

namespace {

constexpr double kSample_s = 1e-3;

AxisParameters frictionless() {
  AxisParameters p;
  p.damping = p.motor_viscosity = p.load_viscosity = 0.0;
  return p;
}

void run(Axis& axis, double torque, int samples) {
  for (int n = 0; n < samples; ++n) axis.advance({torque, 0.0});
}

}  // namespace

TEST_CASE("axis: what goes in is heat, motion and strain, with all that it can hide at once") {
  AxisPhysics all;
  all.motor_friction = 0.03;
  all.motor_stribeck = 0.04;
  all.load_friction = 0.02;
  all.backlash = 2e-3;
  all.progression_angle = 6e-3;
  all.cogging = 0.03;
  all.turning_inertia = 0.2;
  all.rub = 0.1;
  Axis axis({}, all, kSample_s);
  numerics::Random random = numerics::Random::stream(7, 0);
  const double start = axis.energy();
  double worst = 0.0, torque = 0.0;
  int stuck = 0;
  for (int n = 0; n < 20000; ++n) {
    if (n % 20 == 0) torque = 0.4 * random.normal();
    axis.advance({torque, n > 10000 ? 0.05 : 0.0});
    const AxisState& x = axis.state();
    worst = std::max(worst, std::abs(axis.energy() - start - x.work + x.heat));
    stuck += axis.motor_sticks() && axis.load_sticks();
    REQUIRE(std::isfinite(x.motor_speed));
  }
  CHECK(axis.state().heat > 5.0);
  CHECK(stuck > 100);
  CHECK(worst < 1e-6 * axis.state().heat);
}

TEST_CASE("axis: a twisted coupling swings at the frequency of two masses on a spring") {
  const AxisParameters p = frictionless();
  Axis axis(p, {}, kSample_s);
  axis.set_state({1e-3, 0, 0, 0, 0, 0});
  const double omega = std::sqrt(p.stiffness * (1 / p.motor_inertia + 1 / p.load_inertia));
  for (int n = 1; n <= 500; ++n) {
    axis.advance({});
    const AxisState& x = axis.state();
    CHECK(std::abs(x.motor_angle - x.load_angle - 1e-3 * std::cos(omega * kSample_s * n)) < 1e-9);
  }
}

TEST_CASE("axis: dry friction stops a coasting axis when its energy is gone, and holds it there") {
  AxisPhysics dry;
  dry.motor_friction = 0.01;
  dry.load_friction = 0.02;  // as the inertias, so that the coupling stays without twist
  Axis axis(frictionless(), dry, kSample_s);
  axis.set_state({0, 3.0, 0, 3.0, 0, 0});
  run(axis, 0.0, 250);  // deceleration 10 rad/s^2: it stops after 0.3 s
  CHECK(axis.state().motor_speed == Approx(0.5).epsilon(1e-9));
  run(axis, 0.0, 100);
  CHECK(axis.motor_sticks());
  CHECK(axis.load_sticks());
  CHECK(axis.state().motor_speed == 0.0);
  CHECK(axis.state().motor_angle == Approx(0.45).epsilon(1e-9));
  const double there = axis.state().motor_angle;
  run(axis, 0.014, 1000);
  CHECK(axis.load_sticks());
  CHECK(axis.state().load_angle == Approx(0.45).epsilon(1e-9));
  CHECK(axis.state().motor_angle - there <= 2 * 0.004 / 40);  // what the coupling gives way, with its overshoot
}

TEST_CASE("axis: a stuck mass breaks away at the friction at rest and not before") {
  AxisPhysics dry;
  dry.motor_stribeck = 0.05;
  dry.breakaway = 1.6;
  Axis axis({}, dry, kSample_s);
  run(axis, 0.0799, 100);
  CHECK(axis.motor_sticks());
  CHECK(axis.state().motor_angle == 0.0);
  run(axis, 0.0801, 100);
  CHECK_FALSE(axis.motor_sticks());
  CHECK(axis.state().motor_angle > 0.0);
}

TEST_CASE("axis: play lets the motor fly free up to the gap, and an undamped coupling makes an elastic impact") {
  AxisPhysics play;
  play.backlash = 5e-3;
  const AxisParameters p = frictionless();
  Axis axis(p, play, kSample_s);
  axis.set_state({0, 0.1, 0, 0, 0, 0});
  run(axis, 0.0, 49);
  CHECK(axis.state().motor_angle == Approx(4.9e-3).epsilon(1e-12));
  CHECK(axis.state().load_speed == 0.0);
  run(axis, 0.0, 60);  // the impact lasts half a period of the two masses, 12.8 ms
  const double m1 = p.motor_inertia, m2 = p.load_inertia;
  CHECK(axis.state().motor_speed == Approx(0.1 * (m1 - m2) / (m1 + m2)).epsilon(1e-6));
  CHECK(axis.state().load_speed == Approx(0.1 * 2 * m1 / (m1 + m2)).epsilon(1e-6));
}

TEST_CASE("axis: a damped impact pushes and never pulls") {
  AxisPhysics play;
  play.backlash = 1e-3;
  AxisParameters p = frictionless();
  p.damping = 0.2;
  Axis axis(p, play, kSample_s);
  axis.set_state({0, 0.5, 0, 0, 0, 0});
  double last = 0.0;
  for (int n = 0; n < 15; ++n) {
    axis.advance({});
    CHECK(axis.state().load_speed >= last);
    last = axis.state().load_speed;
  }
  CHECK(p.motor_inertia * axis.state().motor_speed + p.load_inertia * axis.state().load_speed ==
        Approx(0.5 * p.motor_inertia).epsilon(1e-9));
  CHECK(axis.state().load_speed > axis.state().motor_speed);
}

TEST_CASE("axis: a coupling has 1.5 times its stiffness at the progression angle") {
  AxisPhysics stiffening;
  stiffening.progression_angle = 8e-3;
  Axis axis({}, stiffening, kSample_s);
  const auto energy = [&axis](double twist) {
    axis.set_state({twist, 0, 0, 0, 0, 0});
    return axis.energy();
  };
  const double h = 1e-5;
  const auto stiffness = [&](double twist) { return (energy(twist + h) - 2 * energy(twist) + energy(twist - h)) / (h * h); };
  CHECK(stiffness(0) == Approx(40).epsilon(1e-4));
  CHECK(stiffness(8e-3) == Approx(60).epsilon(1e-4));
}

TEST_CASE("axis: a rubbing contact takes its share once a turn") {
  AxisPhysics rubbing;
  rubbing.rub = 0.1;
  rubbing.rub_width = 0.4;
  AxisParameters p = frictionless();
  p.stiffness = 1e4;
  Axis axis(p, rubbing, kSample_s);
  const double start = 20.0;
  axis.set_state({1.0, start, 1.0, start, 0, 0});
  run(axis, 0.0, 200);  // 4 rad on: not yet there
  CHECK(axis.state().heat == 0.0);
  run(axis, 0.0, 200);  // past one turn, not two
  CHECK(axis.state().heat == Approx(0.1 * 0.4).epsilon(1e-5));
}
