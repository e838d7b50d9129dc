#include "validation/simulation.hpp"

#include <cmath>

#include "catch.hpp"
#include "models.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

namespace {

records::ModelData lag(double corner_rad_s, double delay_s) {
  records::ModelData m;
  m.numerator = Eigen::VectorXd::Constant(1, 3.0 * corner_rad_s);
  m.denominator = Eigen::Vector2d(1.0, corner_rad_s);
  m.delay_s = delay_s;
  return m;
}

std::string refusal(const records::ModelData& m, double rate_hz) {
  const auto sampled = sampled_model(m, rate_hz);
  return sampled ? "none" : sampled.error().text;
}

}  // namespace

TEST_CASE("simulation: a discrete-time model meets its own data from any state and with any offset") {
  const Eigen::VectorXd u = white(600, 1), y = response_to(u);
  const auto model = sampled_model(second_order(), 100.0);
  REQUIRE(model);
  const Eigen::VectorXd later = y.tail(500).array() + 7.5;  // begins in the midst of the motion
  const auto s = simulate(*model, u.tail(500), later, true);
  REQUIRE(s);
  CHECK(s->first == 0);
  CHECK((s->output - later).cwiseAbs().maxCoeff() < 1e-11);
  CHECK(s->offset == Approx(7.5).epsilon(1e-12));
  const auto without = simulate(*model, u.tail(500), later, false);
  REQUIRE(without);
  CHECK((without->output - later).cwiseAbs().maxCoeff() > 1.0);
}

TEST_CASE("simulation: a continuous-time model has its input held and its delay, whole samples and a rest") {
  // x' = -a x + 3 a u(t - 2.4 h), u held: solved by hand over the two parts of a sample.
  const double a = 40.0, h = 0.01, rest = 0.4 * h;
  const Eigen::VectorXd u = white(400, 2);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(400);
  y[2] = 5.0;
  for (Eigen::Index n = 2; n + 1 < 400; ++n) {
    const double before = n >= 3 ? u[n - 3] : 0.0, now = u[n - 2];
    const double middle = std::exp(-a * rest) * y[n] + 3.0 * (1.0 - std::exp(-a * rest)) * before;
    y[n + 1] = std::exp(-a * (h - rest)) * middle + 3.0 * (1.0 - std::exp(-a * (h - rest))) * now;
  }
  const auto model = sampled_model(lag(a, 2.4 * h), 1.0 / h);
  REQUIRE(model);
  CHECK(model->delay == 2);
  const auto s = simulate(*model, u, y, false);
  REQUIRE(s);
  CHECK(s->first == 2);
  CHECK((s->output - y.tail(398)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("simulation: an integrator leaves its offset open, and meets the data all the same") {
  records::ModelData m = second_order();
  m.numerator = Eigen::VectorXd::Constant(1, 1.0);
  m.denominator = Eigen::Vector2d(1.0, -1.0);
  const Eigen::VectorXd u = white(300, 3);
  Eigen::VectorXd y(300);
  y[0] = 4.0;
  for (Eigen::Index n = 1; n < 300; ++n) y[n] = y[n - 1] + u[n - 1];
  const auto model = sampled_model(m, 100.0);
  REQUIRE(model);
  CHECK(model->largest_pole == Approx(1.0));
  const auto s = simulate(*model, u, y, true);
  REQUIRE(s);
  CHECK((s->output - y).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("simulation: models that do not fit the data are refused by name") {
  CHECK(refusal(second_order(), 50.0) ==
        "its sample time is 0.01 s, that of the data 0.02 s; resample the data, or identify at this rate");
  records::ModelData late = second_order();
  late.delay_s = 0.015;
  CHECK(refusal(late, 100.0) == "its delay of 0.015 s is no whole number of samples");
  records::ModelData improper = lag(10.0, 0.0);
  improper.numerator = Eigen::Vector3d(1.0, 2.0, 3.0);
  CHECK(refusal(improper, 100.0).find("improper") != std::string::npos);

  const auto model = sampled_model(second_order(), 100.0);
  REQUIRE(model);
  const auto s = simulate(*model, white(8, 1), white(8, 2), true);
  REQUIRE_FALSE(s);
  CHECK(s.error().text == "the data have 8 samples; needed: at least 9 for its 2 states and its delay of 0 samples");
  records::ModelData unstable = second_order();
  unstable.denominator = Eigen::Vector3d(1.0, -12.0, 0.7);
  const auto grows = sampled_model(unstable, 100.0);
  REQUIRE(grows);
  const auto beyond = simulate(*grows, white(2000, 1), white(2000, 2), false);
  REQUIRE_FALSE(beyond);
  CHECK(beyond.error().text == "its simulation grows beyond all bounds: it is unstable");
}
