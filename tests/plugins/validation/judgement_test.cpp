#include "validation/judgement.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "models.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

namespace {

Judgement judged(const records::ModelData& m, const Eigen::VectorXd& u, const Eigen::VectorXd& y, JudgementSettings s = {}) {
  const auto j = judge(m, {100.0, u, y}, s);
  if (!j) FAIL(j.error().text);
  return *j;
}

bool warns_of(const Judgement& j, const std::string& words) {
  for (const auto& warning : j.warnings)
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("judgement: the right model of noise-free data has a fit of 100 percent and nothing left to predict") {
  const Eigen::VectorXd u = white(1000, 1);
  const Judgement j = judged(second_order(), u.tail(900), response_to(u).tail(900));
  CHECK(j.fit == Approx(100.0).margin(1e-9));
  CHECK(j.prediction_fit == Approx(100.0).margin(1e-9));
  CHECK(j.residual_std < 1e-12);
  CHECK(j.noise.coefficients.size() == 0);
  CHECK(j.warnings.empty());
}

TEST_CASE("judgement: k-step prediction errors have the variance that known noise gives them") {
  // y = G u + e, e[n] = 0.9 e[n-1] + w with std 0.3: k steps ahead 0.3 sqrt((1 - 0.81^k) / 0.19).
  const Eigen::Index samples = 40000;
  const Eigen::VectorXd u = white(samples, 5), y = response_to(u) + coloured(samples, 0.9, 6, 0.3);
  for (const Eigen::Index k : {1, 3, 10, 50}) {
    JudgementSettings s;
    s.steps = k;
    const Judgement j = judged(second_order(), u, y, s);
    const double expected = 0.3 * std::sqrt((1.0 - std::pow(0.81, static_cast<double>(k))) / 0.19);
    CHECK(j.prediction_std == Approx(expected).epsilon(0.03));
    CHECK(j.expected_prediction_std == Approx(expected).epsilon(0.03));
    CHECK(j.residual_std == Approx(0.3 / std::sqrt(0.19)).epsilon(0.03));
    CHECK(j.one_step_variance == Approx(0.09).epsilon(0.02));
    CHECK(j.residual.whiteness_probability < 1e-6);
    CHECK(j.innovation.whiteness_probability > 1e-3);
    CHECK(j.residual.cross_outside <= 3);
  }
}

TEST_CASE("judgement: fit, FPE and AIC as their formulas say") {
  const Eigen::VectorXd u = white(2000, 7), y = response_to(u) + white(2000, 8, 0.5);
  JudgementSettings s;
  s.noise_order = 0;
  s.offset = false;
  const Judgement j = judged(second_order(), u, y, s);
  const Eigen::VectorXd e = y - j.simulation.output;
  CHECK(j.fit == Approx(100.0 * (1.0 - e.norm() / (y.array() - y.mean()).matrix().norm())).epsilon(1e-12));
  CHECK(j.prediction_fit == Approx(j.fit).epsilon(1e-12));
  const double v = e.squaredNorm() / 2000.0;  // four parameters and two states
  CHECK(j.fpe == Approx(v * 2006.0 / 1994.0).epsilon(1e-12));
  CHECK(j.aic == Approx(2000.0 * std::log(v) + 12.0).epsilon(1e-12));
}

TEST_CASE("judgement: a model that lacks a pole is told by the input in its residual") {
  records::ModelData poor = second_order();
  poor.denominator = Eigen::Vector2d(1.0, -0.8);
  poor.numerator = Eigen::VectorXd::Constant(1, 0.6);
  const Eigen::VectorXd u = white(2000, 9), y = response_to(u) + white(2000, 10, 0.05);
  CHECK(judged(poor, u, y).residual.cross_outside > 5);
  CHECK(judged(second_order(), u, y).residual.cross_outside <= 3);
}

TEST_CASE("judgement: energy outside the fitted band and another amplitude are told") {
  const double pi = std::numbers::pi;
  Eigen::VectorXd two(1000);
  for (Eigen::Index n = 0; n < 1000; ++n)
    two[n] = 3.0 + std::sin(2.0 * pi * 0.05 * static_cast<double>(n)) + 0.5 * std::sin(2.0 * pi * 0.2 * static_cast<double>(n));
  CHECK(energy_outside(two, 100.0, 1.0, 10.0) == Approx(0.2).epsilon(1e-9));
  CHECK(energy_outside(two, 100.0, 5.0, 20.0) == Approx(0.0).margin(1e-9));
  CHECK(energy_outside(two, 100.0, 6.0, 19.0) == Approx(1.0));
  CHECK(energy_outside(Eigen::VectorXd::Constant(10, 2.0), 100.0, 1.0, 2.0) == 0.0);

  records::ModelData m = second_order();
  m.band_hz = Eigen::Vector2d(1.0, 20.0);
  m.input_amplitude = 1.0;
  const Eigen::VectorXd u = white(1000, 11);
  const Judgement j = judged(m, u, response_to(u));
  CHECK(warns_of(j, "of the input's and "));
  CHECK(warns_of(j, "outside the band of 1 to 20 Hz in which it was fitted"));
  CHECK(warns_of(j, "times the 1 V of the data it was fitted to"));
  m.band_hz = Eigen::Vector2d(0.0, 50.0);
  m.input_amplitude = u.cwiseAbs().maxCoeff();
  CHECK(judged(m, u, response_to(u)).warnings.empty());
  const Eigen::VectorXd weak = 0.3 * u;
  CHECK(warns_of(judged(m, weak, response_to(weak)), "validate at the same amplitude"));
}

TEST_CASE("judgement: an unstable model is told, and data that tell nothing are refused") {
  records::ModelData unstable = second_order();
  unstable.denominator = Eigen::Vector3d(1.0, -2.0, 1.0002);
  const Eigen::VectorXd u = white(200, 12);
  CHECK(warns_of(judged(unstable, u, response_to(u)), "it is unstable"));
  const auto constant = judge(second_order(), {100.0, u, Eigen::VectorXd::Constant(200, 3.0)}, {});
  REQUIRE_FALSE(constant);
  CHECK(constant.error().text == "the output is constant: there is nothing to fit");
  const auto few = judge(second_order(), {100.0, u.head(100), response_to(u).head(100)}, {});
  REQUIRE_FALSE(few);
  CHECK(few.error().text == "the data have 100 samples beyond its delay; needed: more than 100 for correlations over 25 lags");
}

TEST_CASE("judgement: an unstable model is predicted through its own poles") {
  // A pole at 1.25, held by the feedback u = r - 0.6 y.
  const Eigen::VectorXd r = white(3000, 5), w = white(3000, 6, 0.2);
  Eigen::VectorXd u = r, y = Eigen::VectorXd::Zero(3000);
  for (Eigen::Index n = 0; n < 3000; ++n) {
    if (n > 0) y[n] = 1.25 * y[n - 1] + u[n - 1] + w[n] - 0.8 * w[n - 1];  // F = 1 - z^-1 / 1.25: the mirrored pole
    u[n] = r[n] - 0.6 * y[n];
  }
  records::ModelData m;
  m.sample_time_s = 0.01;
  m.numerator = Eigen::VectorXd::Ones(1);
  m.denominator = Eigen::Vector2d(1.0, -1.25);
  for (const Eigen::Index steps : {1, 3}) {
    JudgementSettings s;
    s.steps = steps;
    const Judgement j = judged(m, u.head(500), y.head(500), s);
    // psi of F / A: 1, 0.45, 0.5625
    const double expected = steps == 1 ? 0.2 : 0.2 * std::sqrt(1.0 + 0.2025 + 0.31640625);
    CHECK(j.prediction_std == Approx(expected).epsilon(0.1));
    CHECK(j.expected_prediction_std == Approx(expected).epsilon(0.1));
    CHECK(j.prediction_fit > 70.0);
    CHECK(warns_of(j, "it is unstable"));
  }
}

TEST_CASE("judgement: warns of an input that is hardly linear between samples") {
  records::ModelData m;
  m.numerator = Eigen::VectorXd::Constant(1, 40.0);
  m.denominator = Eigen::Vector2d(1.0, 40.0);
  JudgementSettings s;
  s.hold = Hold::first_order;
  const Eigen::VectorXd u = white(600, 1), y = white(600, 2);
  CHECK(warns_of(judged(m, u, y, s), "above a quarter of the sample rate"));
  CHECK_FALSE(warns_of(judged(m, coloured(600, 0.98, 3), y, s), "above a quarter of the sample rate"));
  s.hold = Hold::zero_order;
  CHECK_FALSE(warns_of(judged(m, u, y, s), "above a quarter of the sample rate"));
}
