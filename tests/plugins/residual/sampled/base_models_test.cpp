#include <cmath>
#include <numbers>

#include "bases/drive_axis.hpp"
#include "bases/second_order.hpp"
#include "bases/two_tanks.hpp"
#include "catch.hpp"
#include "model/simulate.hpp"
#include "plugins/residual/declared_base.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

using Complex = std::complex<double>;
const Complex kJ(0.0, 1.0);

MeasuredResponse response_of(const BaseModel& base, const Eigen::VectorXd& values, double first_hz, double ratio, int lines) {
  MeasuredResponse r;
  double f = first_hz;
  for (int k = 0; k < lines; ++k, f *= ratio) {
    r.frequency_hz.push_back(f);
    r.response.push_back(plant_response(base, values, {}, 2.0 * std::numbers::pi * f * kJ)(0, 0));
    r.weight.push_back(1.0 / std::abs(r.response.back()));
  }
  return r;
}

void start_is(const BaseModel& base, const std::vector<MeasuredResponse>& measured, const Eigen::VectorXd& values) {
  const auto starts = base.starts(measured);
  REQUIRE(starts.size() >= 1);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    CHECK(starts[0][static_cast<std::size_t>(i)] == Approx(values[i]).epsilon(1e-6));
}

}  // namespace

TEST_CASE("second order: response of displacement, velocity and acceleration by mass, damping, stiffness") {
  const Eigen::Vector3d v(0.2, 1.5, 900.0);
  const Complex s(0.0, 40.0), expected = 1.0 / (0.2 * s * s + 1.5 * s + 900.0);
  const char* outputs[] = {"displacement", "velocity", "acceleration"};
  Complex factor = 1.0;
  for (const char* output : outputs) {
    const auto base = declared_base<SecondOrder>({{"output", std::string(output)}});
    const Eigen::MatrixXcd g = plant_response(*base, v, {}, s);
    CHECK(std::abs(g(0, 0) - factor * expected) < 1e-12);
    // A force at the bearing or the spring is one less at the input; what passes there is the velocity.
    CHECK(std::abs(g(0, 1) + g(0, 0)) < 1e-12);
    CHECK(std::abs(g(0, 2) + g(0, 0)) < 1e-12);
    CHECK(std::abs(g(1, 0) - s * expected) < 1e-12);
    factor *= s;
  }
}

TEST_CASE("second order: gain, frequency and damping ratio say the same as mass, damping, stiffness") {
  const auto base = declared_base<SecondOrder>({{"form", std::string("resonance")}});
  const double k = 900.0, m = 0.2, c = 1.5;
  const Eigen::Vector3d v(1.0 / k, std::sqrt(k / m) / (2.0 * std::numbers::pi), c / (2.0 * std::sqrt(k * m)));
  const Complex s(0.0, 70.0);
  CHECK(std::abs(plant_response(*base, v, {}, s)(0, 0) - 1.0 / (m * s * s + c * s + k)) < 1e-12);
  start_is(*base, {response_of(*base, v, 1.0, 1.2, 20)}, v);
}

TEST_CASE("second order: starts at the parameters of an exact response, whatever is measured") {
  for (const char* output : {"displacement", "velocity", "acceleration"}) {
    const auto base = declared_base<SecondOrder>({{"output", std::string(output)}});
    const Eigen::Vector3d v(0.2, 1.5, 900.0);
    start_is(*base, {response_of(*base, v, 2.0, 1.15, 25), response_of(*base, v, 3.0, 1.3, 10)}, v);
  }
}

TEST_CASE("second order: refuses an output that moves against the input, and records without a response") {
  const auto base = declared_base<SecondOrder>();
  MeasuredResponse r = response_of(*base, Eigen::Vector3d(0.2, 1.5, 900.0), 2.0, 1.15, 25);
  for (Complex& g : r.response) g = -g;
  CHECK_THROWS_WITH(base->starts({{r}}),
                    "the output moves against the input at low and at high frequencies: check the signs of the signals");
  CHECK_THROWS_WITH(base->starts({}), "the records have no line with a response: nothing to start from");
  LinearPlant plant;
  const double outside[] = {-1.0, 1.0, 1.0};
  CHECK_FALSE(base->state_space(outside, nullptr, plant));
}

TEST_CASE("drive axis: position and velocity by the force, and the force by the position") {
  const Eigen::Vector2d v(95.0, 200.0);
  const Complex s(0.0, 5.0);
  const auto position = declared_base<DriveAxis>({{"force_constant", 35.0}});
  const auto velocity = declared_base<DriveAxis>({{"force_constant", 35.0}, {"output", std::string("velocity")}});
  const auto inverse = declared_base<DriveAxis>({{"force_constant", 35.0}, {"inverse", true}, {"filter", 20.0}});
  const Complex g = 35.0 / (s * (95.0 * s + 200.0));
  CHECK(std::abs(plant_response(*position, v, {}, s)(0, 0) - g) < 1e-12);
  CHECK(std::abs(plant_response(*velocity, v, {}, s)(0, 0) - g * s) < 1e-12);
  const Eigen::MatrixXcd forces = plant_response(*inverse, v, {}, s);
  CHECK(std::abs(forces(0, 0) + forces(0, 1) * s + forces(0, 2) * s * s - 1.0 / g) < 1e-9);
  CHECK(forces(0, 3).real() == Approx(1.0 / 35.0));  // a friction of 1 N needs 1/35 more at the input
  start_is(*position, {response_of(*position, v, 0.1, 1.3, 15)}, v);
  start_is(*velocity, {response_of(*velocity, v, 0.1, 1.3, 15)}, v);
  MeasuredResponse turned = response_of(*position, v, 0.1, 1.3, 15);
  for (std::size_t i = 0; i < turned.response.size(); ++i) {
    turned.response[i] = 1.0 / turned.response[i];
    turned.weight[i] = 1.0 / std::abs(turned.response[i]);
  }
  start_is(*inverse, {turned}, v);
}

TEST_CASE("drive axis: says what it declares and refuses what contradicts itself") {
  CHECK_THROWS_WITH((declared_base<DriveAxis>({{"inverse", true}})),
                    "inverse needs filter: the corner of the low-pass behind the derivatives");
  CHECK_THROWS_WITH((declared_base<DriveAxis>({{"filter", 20.0}})), "filter belongs to inverse, which forms derivatives");
  CHECK_THROWS_WITH((declared_base<DriveAxis>({{"inverse", true}, {"filter", 20.0}, {"output", std::string("velocity")}})),
                    "inverse takes the measured position: output says velocity");
  const auto base = declared_base<DriveAxis>({{"inverse", true}, {"filter", 20.0}, {"delay", 5e-4}});
  CHECK(base->filter_hz() == 20.0);
  CHECK(base->timing().delay_s == -5e-4);
  CHECK(base->inputs().size() == 3);
  CHECK(base->conventions() == std::vector<std::string>{"force constant 1 N by a unit of the motor's input (declared)",
                                                        "force from the measured position: its derivatives and the force pass a "
                                                        "low-pass filter of 20 Hz, forth and back",
                                                        "the motor's input acts 500 us after its sample"});
}

TEST_CASE("two tanks: linear outflow, in either order of the tanks") {
  const auto base = declared_base<TwoTanks>({{"outflow", std::string("linear")}});
  const Eigen::Vector3d v(0.05, 0.08, 0.03);
  const Complex s(0.0, 0.05);
  CHECK(std::abs(plant_response(*base, v, {}, s)(0, 0) - 0.05 * 0.08 / ((s + 0.08) * (s + 0.03))) < 1e-12);
  const auto starts = base->starts({{response_of(*base, v, 1e-3, 1.3, 20)}});
  REQUIRE(starts.size() == 2);
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(starts[0][static_cast<std::size_t>(i)] == Approx(v[i]).epsilon(1e-6));
  // Exchanged tanks answer alike.
  const Eigen::Vector3d other(starts[1][0], starts[1][1], starts[1][2]);
  CHECK(other[1] == Approx(0.03).epsilon(1e-6));
  CHECK(std::abs(plant_response(*base, other, {}, s)(0, 0) - plant_response(*base, v, {}, s)(0, 0)) < 1e-9);
}

TEST_CASE("two tanks: Torricelli's outflow agrees with the linear one at the working level, its slope with differences") {
  const auto base = declared_base<TwoTanks>({{"level", 4.0}});
  REQUIRE(base->has_laws());
  const double v[] = {0.05, 0.08, 0.03};
  const auto outflow = [&](std::size_t place, double level) {
    Signals signals;
    signals.stored = level;
    return base->react(v, nullptr, place, signals);
  };
  CHECK(outflow(2, 4.0).value == Approx(0.08 * 4.0));
  CHECK(outflow(3, 4.0).value == Approx(0.03 * 4.0));
  CHECK(outflow(3, 1.0).value == Approx(0.03 * 2.0));
  CHECK(outflow(0, 4.0).value == 0.0);  // the tank itself loses nothing
  for (const double level : {1e-4, 0.5, 6.0})
    CHECK(outflow(2, level).by_stored ==
          Approx((outflow(2, level * 1.001).value - outflow(2, level * 0.999).value) / (0.002 * level)).epsilon(1e-3));
}

TEST_CASE("two tanks: with Torricelli's law a steady pump fills both to the level at which they run out as fast") {
  const auto base = declared_base<TwoTanks>({{"level", 2.0}});
  JointModel model{base, {}};
  Drive drive;
  drive.input = Eigen::VectorXd::Constant(4000, 3.0);
  drive.sample_time_s = 1.0;
  const auto run = simulate(model, Eigen::Vector3d(0.05, 0.08, 0.06), {}, drive);
  REQUIRE(run);
  // 0.05 * 3 = a sqrt(2 h)
  CHECK(run->stored(3999, 0) == Approx(std::pow(0.15 / 0.08, 2) / 2.0).epsilon(1e-6));
  CHECK(run->output[3999] == Approx(std::pow(0.15 / 0.06, 2) / 2.0).epsilon(1e-6));
}
