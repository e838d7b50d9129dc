#include <cmath>

#include "catch.hpp"
#include "effects/asymmetric_friction.hpp"
#include "effects/backlash.hpp"
#include "effects/cogging.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/cubic_damping.hpp"
#include "effects/cubic_stiffness.hpp"
#include "effects/damping_step.hpp"
#include "effects/dead_time.hpp"
#include "effects/overflow.hpp"
#include "effects/quadratic_damping.hpp"
#include "effects/quadratic_stiffness.hpp"
#include "effects/resistance_drift.hpp"
#include "effects/resistance_step.hpp"
#include "effects/saturation.hpp"
#include "effects/stiffness_drift.hpp"
#include "effects/stiffness_step.hpp"
#include "effects/stop.hpp"
#include "effects/stribeck_friction.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

template <class E>
double over_flow(std::initializer_list<double> p, double flow, double gain = 0.0) {
  Signals s;
  s.flow = flow;
  s.gain = gain;
  return E().react(p.begin(), s, nullptr, nullptr).value;
}

template <class E>
double over_stored(std::initializer_list<double> p, double stored) {
  Signals s;
  s.stored = stored;
  return E().react(p.begin(), s, nullptr, nullptr).value;
}

template <class E>
double over_time(std::initializer_list<double> p, double time_s, double flow, double stored) {
  Signals s;
  s.flow = flow;
  s.stored = stored;
  s.time_s = time_s;
  s.step_s = 1e-3;
  return E().react(p.begin(), s, nullptr, nullptr).value;
}

}  // namespace

TEST_CASE("dead time: takes its voltage in the direction of the current, and less where it would turn it around") {
  CHECK(over_flow<DeadTime>({10.0, 0.01}, 1.0, 0.002) == 10.0);
  CHECK(over_flow<DeadTime>({10.0, 0.01}, -1.0, 0.002) == -10.0);
  CHECK(over_flow<DeadTime>({10.0, 0.01}, 0.015, 0.002) == Approx(5.0));
}

TEST_CASE("dry friction: is its force in movement, less within what it changes in a step, none at rest") {
  CHECK(over_flow<CoulombFriction>({0.4}, 2.0, 0.01) == 0.4);
  CHECK(over_flow<CoulombFriction>({0.4}, -2.0, 0.01) == -0.4);
  CHECK(over_flow<CoulombFriction>({0.4}, 0.001, 0.01) == Approx(0.1));
  CHECK(over_flow<CoulombFriction>({0.4}, 0.0, 0.0) == 0.0);
  CHECK(over_flow<AsymmetricFriction>({0.4, 0.7}, 2.0, 0.01) == 0.4);
  CHECK(over_flow<AsymmetricFriction>({0.4, 0.7}, -2.0, 0.01) == -0.7);
}

TEST_CASE("Stribeck friction: falls from rest to movement, and never so steeply that a step has two solutions") {
  const double third = std::exp(-1.0);
  CHECK(over_flow<StribeckFriction>({0.4, 0.5, 0.1}, 0.1) == Approx(0.4 + 0.2 * third));
  CHECK(over_flow<StribeckFriction>({0.4, 0.5, 0.1}, -10.0) == Approx(-0.4));
  const double gain = 0.5;  // far more than a step should have
  for (double v = -0.5; v < 0.5; v += 1e-3) {
    const double before = v + gain * over_flow<StribeckFriction>({0.4, 0.5, 1e-3}, v, gain);
    const double behind = v + 1e-4 + gain * over_flow<StribeckFriction>({0.4, 0.5, 1e-3}, v + 1e-4, gain);
    REQUIRE(behind > before);
  }
}

TEST_CASE("damping: second and third power act against the movement") {
  CHECK(over_flow<QuadraticDamping>({3.0}, -2.0) == -12.0);
  CHECK(over_flow<CubicDamping>({3.0}, -2.0) == -24.0);
}

TEST_CASE("springs: second and third power, a stop beyond its gap, a coupling that is free within its gap") {
  CHECK(over_stored<QuadraticStiffness>({5.0}, -2.0) == 20.0);
  CHECK(over_stored<CubicStiffness>({5.0}, -2.0) == -40.0);
  CHECK(over_stored<Stop>({0.5, 8.0}, 0.4) == 0.0);
  CHECK(over_stored<Stop>({0.5, 8.0}, -0.75) == -2.0);
  const double stiffness = 8.0;
  for (const double x : {-0.9, -0.3, 0.0, 0.2, 0.75}) {
    const double torque = stiffness * x + over_stored<Backlash>({0.5, stiffness}, x);
    CHECK(torque == Approx(stiffness * (x > 0.5 ? x - 0.5 : x < -0.5 ? x + 0.5 : 0.0)).margin(1e-15));
  }
}

TEST_CASE("cogging: repeats after its period") {
  CHECK(over_stored<Cogging>({3.0, 4.0, 0.2}, 0.0) == Approx(4.0));
  CHECK(over_stored<Cogging>({3.0, 4.0, 0.2}, 0.05) == Approx(3.0));
  CHECK(over_stored<Cogging>({3.0, 4.0, 0.2}, 1.237) == Approx(over_stored<Cogging>({3.0, 4.0, 0.2}, 0.037)));
}

TEST_CASE("saturation: is odd, begins with the third power, and is straight far beyond the knee") {
  const double flux = 1e-3;
  CHECK(over_stored<Saturation>({0.7, 5.0, 2.5}, flux) == Approx(0.7 * flux * flux * flux).epsilon(1e-4));
  CHECK(over_stored<Saturation>({0.7, 5.0, 2.5}, -0.8) == -over_stored<Saturation>({0.7, 5.0, 2.5}, 0.8));
  CHECK(over_stored<Saturation>({0.7, 5.0, 2.5}, 1e3) == Approx(5.0 / 2.5 * 1e3).epsilon(1e-4));
}

TEST_CASE("overflow: only above the level") {
  CHECK(over_stored<Overflow>({10.0, 3.0}, 9.9) == 0.0);
  CHECK(over_stored<Overflow>({10.0, 3.0}, 12.0) == 6.0);
}

TEST_CASE("what changes with time: drifts from 0, jumps at its instant and spread over a step") {
  CHECK(over_time<ResistanceDrift>({0.5}, 2.0, 3.0, 7.0) == 3.0);
  CHECK(over_time<StiffnessDrift>({0.5}, 2.0, 3.0, 7.0) == 7.0);
  CHECK(over_time<ResistanceStep>({0.5, 1.0}, 0.999, 3.0, 7.0) == 0.0);
  CHECK(over_time<ResistanceStep>({0.5, 1.0}, 1.0, 3.0, 7.0) == Approx(0.75));
  CHECK(over_time<ResistanceStep>({0.5, 1.0}, 1.001, 3.0, 7.0) == 1.5);
  CHECK(over_time<DampingStep>({0.5, 1.0}, 2.0, 3.0, 7.0) == 1.5);
  CHECK(over_time<StiffnessStep>({0.5, 1.0}, 2.0, 3.0, 7.0) == 3.5);
}
