#include <cmath>
#include <functional>
#include <numbers>

#include "all_effects.hpp"
#include "bases/second_order.hpp"
#include "bases/two_mass.hpp"
#include "catch.hpp"
#include "model/simulate.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using residual::testing::Tried;

namespace {

constexpr double kSample = 5e-3;

/// An effect at a place of a base model.
Addition added(const std::string& name, std::size_t place, const Situation& s) {
  for (const Tried& t : residual::testing::laws_maps_and_tones()) {
    if (t.what.name() != name) continue;
    Addition a;
    a.what = t.what;
    a.effect = t.effect;
    a.place = place;
    a.situation = s;
    a.parameters = t.effect->parameters(s);
    a.label = name;
    return a;
  }
  FAIL("no effect " << name);
  return {};
}

Eigen::VectorXd joined(std::vector<double> base, const std::vector<double>& more) {
  base.insert(base.end(), more.begin(), more.end());
  return Eigen::Map<const Eigen::VectorXd>(base.data(), static_cast<Eigen::Index>(base.size()));
}

/// Tones held over each sample.
Eigen::VectorXd shaken(Eigen::Index samples, double size) {
  Eigen::VectorXd u(samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const double t = kSample * static_cast<double>(n);
    u[n] = size * (std::sin(2.0 * std::numbers::pi * 7.3 * t) + 0.7 * std::sin(2.0 * std::numbers::pi * 11.9 * t + 1.0) +
                   0.5 * std::sin(2.0 * std::numbers::pi * 2.1 * t));
  }
  return u;
}

Drive drive(const Eigen::VectorXd& u) {
  Drive d;
  d.input = u;
  d.sample_time_s = kSample;
  return d;
}

// An oscillator of 8 Hz, in the words of this test.
constexpr double kMass = 2.0, kDamping = 5.0, kStiffness = 5000.0;

/// x at the samples by many small steps: smooth forces by the classical rule of fourth order, then dry friction against the
/// velocity that is left, which it can stop but not turn around (time stepping of Moreau and Jean).
Eigen::VectorXd oscillator(const Eigen::VectorXd& u, int small_steps, const std::function<double(double, double, double)>& force,
                           const std::function<double(double)>& dry) {
  Eigen::VectorXd y(u.size());
  const double h = kSample / small_steps;
  double x = 0.0, v = 0.0;
  for (Eigen::Index n = 0; n < u.size(); ++n) {
    y[n] = x;
    for (int s = 0; s < small_steps; ++s) {
      const double t = kSample * static_cast<double>(n) + s * h;
      const auto a = [&](double at, double xx, double vv) {
        return (u[n] - kDamping * vv - kStiffness * xx - force(xx, vv, at)) / kMass;
      };
      const double v1 = v, a1 = a(t, x, v1), v2 = v + 0.5 * h * a1, a2 = a(t + 0.5 * h, x + 0.5 * h * v1, v2);
      const double v3 = v + 0.5 * h * a2, a3 = a(t + 0.5 * h, x + 0.5 * h * v2, v3);
      const double v4 = v + h * a3, a4 = a(t + h, x + h * v3, v4);
      const double xn = x + h / 6.0 * (v1 + 2.0 * (v2 + v3) + v4);
      const double free = v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4), stopped = h * dry(free) / kMass;
      const double vn = std::abs(free) <= stopped ? 0.0 : free - std::copysign(stopped, free);
      x = dry(free) > 0.0 ? x + 0.5 * h * (v + vn) : xn;
      v = vn;
    }
  }
  return y;
}

const auto kNoDry = [](double) { return 0.0; };
const auto kNoForce = [](double, double, double) { return 0.0; };

/// The difference of two courses over the size of what the effect does.
double distance(const Eigen::VectorXd& found, const Eigen::VectorXd& wanted, const Eigen::VectorXd& without) {
  return (found - wanted).norm() / (wanted - without).norm();
}

Eigen::VectorXd simulated(const std::string& name, std::size_t place, const std::vector<double>& p, const Eigen::VectorXd& u) {
  JointModel model;
  model.base = std::make_shared<SecondOrder>();
  model.additions = {added(name, place, {})};
  return simulate(model, joined({kMass, kDamping, kStiffness}, p), {}, drive(u)).value().output;
}

/// How far a law in the oscillator is from the independent simulation.
double off(const std::string& name, std::size_t place, const std::vector<double>& p, double size,
           const std::function<double(double, double, double)>& force, const std::function<double(double)>& dry,
           int small_steps) {
  const Eigen::VectorXd u = shaken(600, size), without = oscillator(u, small_steps, kNoForce, kNoDry);
  return distance(simulated(name, place, p, u), oscillator(u, small_steps, force, dry), without);
}

/// The same with a law that keeps a state z of its own: dz/dt and the force, both over v and z.
Eigen::VectorXd with_state(const Eigen::VectorXd& u, int small_steps, const std::function<double(double, double)>& slope,
                           const std::function<double(double, double)>& force) {
  using State = Eigen::Vector3d;
  Eigen::VectorXd y(u.size());
  const double h = kSample / small_steps;
  State s = State::Zero();
  for (Eigen::Index n = 0; n < u.size(); ++n) {
    y[n] = s[0];
    const auto f = [&](const State& x) {
      return State(x[1], (u[n] - kDamping * x[1] - kStiffness * x[0] - force(x[1], x[2])) / kMass, slope(x[1], x[2]));
    };
    for (int i = 0; i < small_steps; ++i) {
      const State k1 = f(s), k2 = f(s + 0.5 * h * k1), k3 = f(s + 0.5 * h * k2), k4 = f(s + h * k3);
      s += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
    }
  }
  return y;
}

constexpr std::size_t kBearing = 0, kSpring = 1;

}  // namespace

TEST_CASE("laws in an oscillator: smooth ones as an integration by small steps says") {
  const int n = 40;
  CHECK(off(
            "cubic_stiffness", kSpring, {2e8}, 10.0, [](double x, double, double) { return 2e8 * x * x * x; }, kNoDry, n) < 1e-3);
  CHECK(off(
            "quadratic_stiffness", kSpring, {1e5}, 10.0, [](double x, double, double) { return 1e5 * x * x; }, kNoDry, n) < 1e-3);
  CHECK(off(
            "quadratic_damping", kBearing, {40.0}, 10.0, [](double, double v, double) { return 40.0 * v * std::abs(v); }, kNoDry,
            n) < 1e-3);
  CHECK(off(
            "cubic_damping", kBearing, {80.0}, 10.0, [](double, double v, double) { return 80.0 * v * v * v; }, kNoDry, n) <
        1e-3);
  CHECK(off(
            "cogging", kBearing, {3.0, 1.0, 0.003}, 10.0,
            [](double x, double, double) {
              const double a = 2.0 * std::numbers::pi * x / 0.003;
              return 3.0 * std::sin(a) + std::cos(a);
            },
            kNoDry, n) < 1e-2);
  CHECK(off(
            "stiffness_drift", kSpring, {300.0}, 10.0, [](double x, double, double t) { return 300.0 * t * x; }, kNoDry, n) <
        1e-3);
  CHECK(off(
            "stiffness_step", kSpring, {500.0, 1.2345}, 10.0,
            [](double x, double, double t) { return t > 1.2345 ? 500.0 * x : 0.0; }, kNoDry, n) < 1e-2);
  CHECK(off(
            "damping_step", kBearing, {5.0, 1.2345}, 10.0, [](double, double v, double t) { return t > 1.2345 ? 5.0 * v : 0.0; },
            kNoDry, n) < 1e-2);
}

TEST_CASE("laws in an oscillator: a stop, with its corners") {
  const double gap = 2e-3, k = 4e3;
  CHECK(off(
            "stop", kSpring, {gap, k}, 10.0,
            [=](double x, double, double) { return std::abs(x) > gap ? k * (x - std::copysign(gap, x)) : 0.0; }, kNoDry,
            100) < 1e-2);
}

TEST_CASE("laws in an oscillator: dry friction that sticks, as time stepping with exact rest says") {
  for (const double force : {0.5, 3.0, 6.0})
    CHECK(off(
              "coulomb_friction", kBearing, {force}, 10.0, kNoForce, [=](double) { return force; }, 1000) < 1e-2);
  CHECK(off(
            "asymmetric_friction", kBearing, {2.0, 4.0}, 10.0, kNoForce, [](double v) { return v > 0.0 ? 2.0 : 4.0; }, 1000) <
        1e-2);
  CHECK(off(
            "stribeck_friction", kBearing, {2.0, 0.5, 0.05}, 10.0, kNoForce,
            [](double v) { return 2.0 + std::exp(-v * v / 0.0025); }, 1000) < 2e-2);
}

TEST_CASE("laws in an oscillator: friction and hysteresis with a memory, as their differential equations say") {
  const Eigen::VectorXd u = shaken(600, 10.0), without = oscillator(u, 100, kNoForce, kNoDry);
  for (const double stiffness : {3e3, 3e4}) {
    const Eigen::VectorXd dahl = with_state(
        u, 300, [=](double v, double f) { return stiffness * (v - std::abs(v) * f / 3.0); }, [](double, double f) { return f; });
    CHECK(distance(simulated("dahl_friction", kBearing, {3.0, stiffness}, u), dahl, without) < 5e-3);
  }
  const double reach = 1e-3, beta = 0.75 / reach, gamma = 0.25 / reach;  // m = 0.5
  const Eigen::VectorXd wen = with_state(
      u, 300, [=](double v, double z) { return v - beta * std::abs(v) * z - gamma * v * std::abs(z); },
      [](double, double z) { return 2000.0 * z; });
  CHECK(distance(simulated("bouc_wen", kSpring, {2000.0, reach, 0.5}, u), wen, without) < 2e-3);
  const auto fade = [](double v) { return std::exp(-v * v / 4e-4); };
  const auto bend = [&](double v, double z) { return v - 3e4 * std::abs(v) * z / (2.0 + fade(v)); };
  const Eigen::VectorXd lugre =
      with_state(u, 300, bend, [&](double v, double z) { return 3e4 * z + 5.0 * fade(v) * bend(v, z); });
  CHECK(distance(simulated("lugre_friction", kBearing, {2.0, 3e4, 0.5, 0.02, 5.0}, u), lugre, without) < 5e-3);
}
