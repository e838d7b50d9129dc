#include <algorithm>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "all_effects.hpp"
#include "catch.hpp"
#include "effects/bouc_wen.hpp"
#include "effects/dahl_friction.hpp"
#include "effects/lugre_friction.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

/// A movement: its position over time, with its velocity.
struct Movement {
  std::function<double(double)> position, velocity;
};

/// Positions, velocities, forces at the steps, and the work done against the law.
struct Course {
  std::vector<double> position, force;
  double work = 0.0;
};

template <class E>
Course course(const std::vector<double>& p, const Movement& m, double step_s, int steps) {
  const E law;
  Course c;
  double memory[3] = {0.0, 0.0, 0.0}, next[3] = {0.0, 0.0, 0.0}, before = 0.0, from = m.position(0.0);
  for (int n = 0; n <= steps; ++n) {
    Signals s;
    s.step_s = step_s;
    s.time_s = n * step_s;
    s.stored = m.position(s.time_s);
    s.flow = m.velocity(s.time_s);
    const double force = law.react(p.data(), s, memory, next).value;
    std::copy(next, next + 3, memory);
    c.work += 0.5 * (before + force) * (s.stored - from);
    before = force;
    from = s.stored;
    c.position.push_back(s.stored);
    c.force.push_back(force);
  }
  return c;
}

Movement two_tones() {
  return {[](double t) { return 1.0 - std::cos(t) + 0.4 * std::sin(3.7 * t); },
          [](double t) { return std::sin(t) + 0.4 * 3.7 * std::cos(3.7 * t); }};
}

/// The classical fourth-order rule for one state.
double integrated(const std::function<double(double, double)>& slope, double t_end, int steps) {
  double z = 0.0;
  const double h = t_end / steps;
  for (int n = 0; n < steps; ++n) {
    const double t = n * h, k1 = slope(t, z), k2 = slope(t + 0.5 * h, z + 0.5 * h * k1);
    const double k3 = slope(t + 0.5 * h, z + 0.5 * h * k2), k4 = slope(t + h, z + h * k3);
    z += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  }
  return z;
}

}  // namespace

TEST_CASE("Dahl friction: is the solution of its differential equation") {
  const double limit = 0.8, stiffness = 5.0, t_end = 9.0;
  const Movement m = two_tones();
  const double wanted = integrated(
      [&](double t, double force) {
        const double v = m.velocity(t);
        return stiffness * (v - std::abs(v) * force / limit);
      },
      t_end, 200000);
  CHECK(course<DahlFriction>({limit, stiffness}, m, t_end / 20000, 20000).force.back() == Approx(wanted).epsilon(1e-5));
  CHECK(course<DahlFriction>({limit, stiffness}, m, t_end / 200, 200).force.back() == Approx(wanted).epsilon(1e-2));
}

TEST_CASE("Bouc-Wen: is Wen's differential equation with n = 1") {
  const double stiffness = 3.0, reach = 0.3, t_end = 9.0;
  const Movement m = two_tones();
  for (const double back : {1e-6, 0.5, 1.0, 2.5}) {
    const double beta = (1.0 + back) / (2.0 * reach), gamma = (1.0 - back) / (2.0 * reach);
    const double z = integrated(
        [&](double t, double d) {
          const double v = m.velocity(t);
          return v - beta * std::abs(v) * d - gamma * v * std::abs(d);
        },
        t_end, 200000);
    INFO("m = " << back);
    CHECK(course<BoucWen>({stiffness, reach, back}, m, t_end / 4000, 4000).force.back() == Approx(stiffness * z).epsilon(1e-4));
  }
}

TEST_CASE("LuGre friction: is the solution of its differential equation") {
  const double sliding = 0.8, stiffness = 20.0, more = 0.4, velocity = 0.3, damping = 0.05, t_end = 9.0;
  const Movement m = two_tones();
  const auto fade = [&](double v) { return std::exp(-v * v / (velocity * velocity)); };
  const auto bend = [&](double t, double z) {
    const double v = m.velocity(t);
    return v - stiffness * std::abs(v) * z / (sliding + more * fade(v));
  };
  const double z = integrated(bend, t_end, 200000), v = m.velocity(t_end);
  const double wanted = stiffness * z + damping * fade(v) * bend(t_end, z);
  const std::vector<double> p = {sliding, stiffness, more / sliding, velocity, damping};
  CHECK(course<LugreFriction>(p, m, t_end / 8000, 8000).force.back() == Approx(wanted).epsilon(1e-4));
  CHECK(course<LugreFriction>(p, m, t_end / 400, 400).force.back() == Approx(wanted).epsilon(0.03));
}

TEST_CASE("friction and hysteresis: the force depends on the path, not on how fast it is run through") {
  const double t_end = 9.0;
  const int steps = 20000;
  const Movement even = two_tones();
  const Movement faster = {[&](double t) { return even.position(t * t / t_end); },
                           [&](double t) { return even.velocity(t * t / t_end) * 2.0 * t / t_end; }};
  const auto same = [&](const Course& a, const Course& b) { CHECK(a.force.back() == Approx(b.force.back()).epsilon(1e-4)); };
  const std::vector<double> dahl = {0.8, 5.0}, wen = {3.0, 0.3, 0.5};
  same(course<DahlFriction>(dahl, even, t_end / steps, steps), course<DahlFriction>(dahl, faster, t_end / steps, steps));
  same(course<BoucWen>(wen, even, t_end / steps, steps), course<BoucWen>(wen, faster, t_end / steps, steps));
}

TEST_CASE("friction and hysteresis: loops close after a while, within the limits, and take energy") {
  const double turn = 2.0 * std::numbers::pi;
  const Movement sine = {[](double t) { return std::sin(t); }, [](double t) { return std::cos(t); }};
  const int steps = 2000;
  const auto check = [&](const Course& c, double limit) {
    for (int n = 0; n <= steps; n += 50) {
      const auto i = static_cast<std::size_t>(4 * steps + n), later = i + static_cast<std::size_t>(steps);
      REQUIRE(c.force[i] == Approx(c.force[later]).margin(1e-6 * limit));
    }
    double loop = 0.0;
    for (std::size_t i = 4 * steps; i < 5 * steps; ++i)
      loop += 0.5 * (c.force[i] + c.force[i + 1]) * (c.position[i + 1] - c.position[i]);
    CHECK(loop > 0.1 * limit);
    CHECK(loop < 4.0 * limit * 1.001);  // the rectangle around the loop
    for (const double f : c.force) REQUIRE(std::abs(f) <= limit * (1.0 + 1e-9));
  };
  check(course<DahlFriction>({0.8, 5.0}, sine, turn / steps, 6 * steps), 0.8);
  check(course<BoucWen>({2.0, 0.4, 0.5}, sine, turn / steps, 6 * steps), 0.8);
  check(course<LugreFriction>({0.8, 20.0, 0.25, 0.1, 0.01}, sine, turn / steps, 6 * steps), 1.0);
}

TEST_CASE("friction and hysteresis: no movement from rest ever gains energy") {
  numerics::Random random(11);
  for (int draw = 0; draw < 20; ++draw) {
    double a[4], w[4], phase[4];
    for (int i = 0; i < 4; ++i)
      a[i] = 0.3 * random.normal(), w[i] = 0.5 + 4.0 * random.uniform(), phase[i] = 6.28 * random.uniform();
    const auto sum = [=](double t, bool slope) {
      double x = 0.0;
      for (int i = 0; i < 4; ++i) x += slope ? a[i] * w[i] * std::cos(w[i] * t + phase[i]) : a[i] * std::sin(w[i] * t + phase[i]);
      return x;
    };
    const Movement m = {[=](double t) { return sum(t, false); }, [=](double t) { return sum(t, true); }};
    for (const int steps : {300, 3000, 7000}) {
      const double h = 2e-3;
      CHECK(course<DahlFriction>({0.8, 5.0}, m, h, steps).work > -1e-6);
      CHECK(course<BoucWen>({2.0, 0.4, 0.5}, m, h, steps).work > -1e-6);
      CHECK(course<LugreFriction>({0.8, 20.0, 0.25, 0.1, 0.05}, m, h, steps).work > -1e-6);
    }
  }
}

TEST_CASE("friction without memory: never gives energy at any velocity") {
  for (const auto& t : residual::testing::laws_maps_and_tones()) {
    const std::string name = t.what.name();
    if (name != "coulomb_friction" && name != "asymmetric_friction" && name != "stribeck_friction" && name != "dead_time" &&
        name != "quadratic_damping" && name != "cubic_damping")
      continue;
    INFO(name);
    auto p = t.effect->starts(residual::testing::situation(t.what.kinds[0])).back();
    for (double& v : p) v = v > 0.0 ? v : 0.3;
    for (double v = -2.0; v <= 2.0; v += 0.01) {
      Signals s;
      s.flow = v;
      s.gain = 1e-2;
      REQUIRE(t.effect->react(p.data(), s, nullptr, nullptr).value * v >= 0.0);
    }
  }
}
