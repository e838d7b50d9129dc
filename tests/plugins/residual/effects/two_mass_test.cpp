#include "bases/two_mass.hpp"

#include <bodeflow/describe.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "../declared_base.hpp"
#include "all_effects.hpp"
#include "catch.hpp"
#include "model/simulate.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

using Complex = std::complex<double>;

// Motor inertia, load inertia, stiffness, coupling damping, motor and load friction: resonance at 30 Hz, antiresonance at 17 Hz.
const Eigen::VectorXd kDrive = (Eigen::VectorXd(6) << 2e-3, 4e-3, 47.0, 0.02, 0.01, 0.02).finished();

/// Angles of motor and load for a unit of torque, from the two equations of movement.
Eigen::Vector2cd angles(const Eigen::VectorXd& v, Complex s) {
  const Complex link = v[2] + v[3] * s;
  Eigen::Matrix2cd m;
  m << v[0] * s * s + v[4] * s + link, -link, -link, v[1] * s * s + v[5] * s + link;
  const Complex determinant = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
  return {m(1, 1) / determinant, -m(1, 0) / determinant};
}

MeasuredResponse measured(const std::function<Complex(Complex)>& response) {
  MeasuredResponse m;
  for (double f = 1.0; f <= 120.0; f += 2.0) {
    m.frequency_hz.push_back(f);
    m.response.push_back(response(Complex(0.0, 2.0 * std::numbers::pi * f)));
    m.weight.push_back(1.0 / std::abs(m.response.back()));
  }
  return m;
}

}  // namespace

TEST_CASE("two-mass model: its response is that of the equations of movement") {
  const TwoMass base;
  for (const double f : {0.5, 17.0, 25.0, 60.0}) {
    const Complex s(0.0, 2.0 * std::numbers::pi * f);
    const Eigen::MatrixXcd g = plant_response(base, kDrive, {}, s);
    const Eigen::Vector2cd q = angles(kDrive, s);
    CHECK(std::abs(g(0, 0) / q[0] - 1.0) < 1e-9);
    CHECK(std::abs(g(1, 0) / (s * q[0]) - 1.0) < 1e-9);           // flow of the motor's bearing
    CHECK(std::abs(g(2, 0) / (s * q[1]) - 1.0) < 1e-9);           // of the load's
    CHECK(std::abs(g(3, 0) / (s * (q[0] - q[1])) - 1.0) < 1e-9);  // of the coupling
    CHECK(std::abs(g(0, 1) / -q[0] - 1.0) < 1e-9);                // a reaction in the motor's bearing brakes
    CHECK(std::abs(g(0, 2) / -q[1] - 1.0) < 1e-9);                // reciprocity: load to motor as motor to load
    CHECK(std::abs(g(0, 3) / (q[1] - q[0]) - 1.0) < 1e-9);        // the coupling pulls both
  }
}

TEST_CASE("two-mass model: declared outputs and inputs are those of the equations of movement") {
  const Complex s(0.0, 2.0 * std::numbers::pi * 25.0);
  const auto response = [&](const std::vector<Declared>& declared, const Eigen::VectorXd& v) {
    return plant_response(*declared_base<TwoMass>(declared), v, {}, s)(0, 0);
  };
  const Complex motor = angles(kDrive, s)[0];
  CHECK(std::abs(response({{"output", std::string("motor_speed")}}, kDrive) / (s * motor) - 1.0) < 1e-9);
  CHECK(std::abs(response({{"input", std::string("current")}, {"torque_constant", 0.25}}, kDrive) / (0.25 * motor) - 1.0) < 1e-9);
  CHECK(std::abs(response({{"input", std::string("current")}}, kDrive) / motor - 1.0) < 1e-9);
  Eigen::VectorXd at_motor = kDrive;
  at_motor[5] = 0.0;
  const Complex load = angles(at_motor, s)[1];
  CHECK(std::abs(response({{"output", std::string("load_angle")}}, at_motor.head(5)) / load - 1.0) < 1e-9);
  CHECK(std::abs(response({{"output", std::string("load_speed")}}, at_motor.head(5)) / (s * load) - 1.0) < 1e-9);
  CHECK(declared_base<TwoMass>({{"input", std::string("current")}})->parameters()[0].unit == "A*s^2/rad");
  CHECK(declared_base<TwoMass>()->parameters()[2].unit == "Nm/rad");
  CHECK_THROWS_WITH(declared_base<TwoMass>({{"torque_constant", 0.25}}),
                    "torque_constant belongs to a current; input is 'torque'");
}

TEST_CASE("two-mass model: from the load alone, the start has its resonance and inertia") {
  const auto base = declared_base<TwoMass>({{"output", std::string("load_angle")}});
  const MeasuredResponse m = measured([&](Complex s) { return angles(kDrive, s)[1]; });
  const auto starts = base->starts({&m, 1});
  REQUIRE(starts.size() == 3);
  for (const auto& v : starts) {
    CHECK(v[0] + v[1] == Approx(kDrive[0] + kDrive[1]).epsilon(0.2));
    CHECK(v[2] * (1.0 / v[0] + 1.0 / v[1]) == Approx(kDrive[2] * (1.0 / kDrive[0] + 1.0 / kDrive[1])).epsilon(0.2));
  }
}

TEST_CASE("two-mass model: outside of its domain it says so") {
  LinearPlant plant;
  const TwoMass base;
  CHECK(base.state_space(kDrive.data(), nullptr, plant));
  for (const Eigen::Index i : {0, 1, 2, 3, 4, 5}) {
    Eigen::VectorXd v = kDrive;
    v[i] = -v[i];
    CHECK_FALSE(base.state_space(v.data(), nullptr, plant));
  }
}

TEST_CASE("two-mass model: starts are near the plant, also behind a delay") {
  const TwoMass base;
  for (const double delay : {0.0, 5e-4}) {
    const MeasuredResponse m = measured([&](Complex s) { return angles(kDrive, s)[0] * std::exp(-s * delay); });
    const auto starts = base.starts({&m, 1});
    REQUIRE(starts.size() == 3);
    for (const int i : {0, 1, 2}) CHECK(starts[0][static_cast<std::size_t>(i)] == Approx(kDrive[i]).epsilon(0.2));
  }
}

TEST_CASE("two-mass model: a response with the wrong sign or of few lines is refused") {
  const TwoMass base;
  MeasuredResponse m = measured([&](Complex s) { return -angles(kDrive, s)[0]; });
  CHECK_THROWS_WITH(base.starts({&m, 1}),
                    "the output moves against the input at low frequencies: check the signs of the signals");
  m.frequency_hz.resize(3), m.response.resize(3), m.weight.resize(3);
  CHECK_THROWS_WITH(base.starts({&m, 1}), "the base model needs at least 4 excited lines, found 3");
}

TEST_CASE(
    "two-mass model: backlash, dry friction and cogging together, sticking, over many samples, lose energy and stay finite") {
  JointModel model;
  model.base = std::make_shared<TwoMass>();
  std::vector<double> values(kDrive.data(), kDrive.data() + kDrive.size());
  const auto add = [&](const std::string& name, std::size_t place, const std::vector<double>& p) {
    for (const auto& t : residual::testing::laws_maps_and_tones()) {
      if (t.what.name() != name) continue;
      Addition a;
      a.what = t.what;
      a.effect = t.effect;
      a.place = place;
      a.situation.place = model.base->places()[place];
      a.parameters = t.effect->parameters(a.situation);
      model.additions.push_back(a);
      values.insert(values.end(), p.begin(), p.end());
    }
  };
  const double gap = 5e-3;
  add("backlash", 2, {gap, kDrive[2]});
  add("coulomb_friction", 0, {0.05});
  add("coulomb_friction", 1, {0.1});
  add("cogging", 0, {0.03, 0.0, 2.0 * std::numbers::pi / 24.0});
  Drive d;
  d.sample_time_s = 1e-3;
  d.input = Eigen::MatrixXd::Zero(20000, 1);
  for (Eigen::Index n = 0; n < 15000; ++n) {
    const double t = 1e-3 * static_cast<double>(n);
    d.input(n, 0) = 0.3 * std::sin(4.0 * t) + 0.2 * std::sin(31.0 * t);
  }
  const auto s =
      simulate(model, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())), {}, d);
  REQUIRE(s);
  REQUIRE(s->output.allFinite());
  // The torque is off for the last 5 s: everything stands but for the creep of a spread jump, the coupling within its gap or held
  // by friction.
  const Eigen::Index last = d.input.rows() - 1;
  CHECK(std::abs(s->flow(last, 0)) < 1e-4);
  CHECK(std::abs(s->flow(last, 1)) < 1e-4);
  CHECK(std::abs(s->output[last] - s->output[last - 1000]) < 1e-4);
  CHECK(std::abs(s->stored(last, 2)) < gap + 0.1 / kDrive[2] + 1e-6);
  // It had moved, and stuck in between.
  CHECK(s->output.cwiseAbs().maxCoeff() > 0.05);
  int stuck = 0;
  for (Eigen::Index n = 0; n < 15000; ++n) stuck += std::abs(s->flow(n, 1)) < 1e-4;
  CHECK(stuck > 500);
}
