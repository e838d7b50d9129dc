#include "validation/first_order_hold.hpp"

#include <cmath>

#include "catch.hpp"
#include "models.hpp"
#include "validation/simulation.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

namespace {

/// (3 s + 3 a) / (s + 2 a) behind a delay.
records::ModelData lead(double a, double delay_s) {
  records::ModelData m;
  m.numerator = Eigen::Vector2d(3.0, 3.0 * a);
  m.denominator = Eigen::Vector2d(1.0, 2.0 * a);
  m.delay_s = delay_s;
  return m;
}

/// Its output at the samples of a triangle that rises from 0 at sample 3 to 1 at sample 4 and falls to 0 at sample 5: three
/// ramps, each answered by integrals of the step response 3 / 2 + 3 / 2 exp(-2 a t).
double answer(double a, double time, double h) {
  const auto ramp = [a](double t) { return t <= 0.0 ? 0.0 : 1.5 * t + 1.5 * (1.0 - std::exp(-2.0 * a * t)) / (2.0 * a); };
  return (ramp(time - 3.0 * h) - 2.0 * ramp(time - 4.0 * h) + ramp(time - 5.0 * h)) / h;
}

}  // namespace

TEST_CASE("first-order hold: exact for an input that is linear between samples, at any delay") {
  const double a = 30.0, h = 0.01;
  for (const double delay : {0.0, 1.0, 0.3, 2.75}) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(60), y(60);
    u[4] = 1.0;
    for (Eigen::Index n = 0; n < 60; ++n) y[n] = answer(a, (static_cast<double>(n) - delay) * h, h);
    const auto model = sampled_model(lead(a, delay * h), 1.0 / h, Hold::first_order);
    REQUIRE(model);
    CHECK(model->delay == static_cast<Eigen::Index>(delay));
    const auto s = simulate(*model, u, y, true);
    REQUIRE(s);
    CHECK(s->initial_state.cwiseAbs().maxCoeff() < 1e-11);
    CHECK((s->output - y.tail(60 - model->delay)).cwiseAbs().maxCoeff() < 1e-12);
    const auto held = sampled_model(lead(a, delay * h), 1.0 / h);
    REQUIRE(held);
    CHECK((simulate(*held, u, y, true)->output - y.tail(60 - held->delay)).cwiseAbs().maxCoeff() > 0.1);
  }
}

TEST_CASE("first-order hold: refuses what a zero-order hold refuses") {
  const auto model = sampled_model(lead(1.0, -0.1), 100.0, Hold::first_order);
  REQUIRE_FALSE(model);
  CHECK(model.error().text == "the delay must not be negative");
}
