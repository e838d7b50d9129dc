#include "catch.hpp"
#include "loop.hpp"

using namespace bodeflow::test;

namespace {

/// Replays a reference run through the whole scheme and gives the largest differences to it.
struct Differences {
  double y = 0.0, u = 0.0, response = 0.0, coefficients = 0.0;
};

Differences replay(const std::string& name, double p0) {
  auto columns = csv_columns(std::string(BODEFLOW_TEST_DATA "/adaptive_control/") + name);
  Example e = example_1();
  without_nets(e);
  e.bank.point.p0 = p0;
  ac::AdaptiveController controller(*ac::EstimatorBank::make(e.bank), *ac::Designer::make(e.design), ac::RstController(), false);
  SimulatedPlant plant(e.plant, e.delay);
  Differences d;
  for (std::size_t k = 0; k < columns["k"].size(); ++k) {
    const double y = plant.output() + (columns.count("e") != 0 ? columns["e"][k] : 0.0);
    const double u = controller.step(y, columns["uc"][k]);
    plant.input(u + columns["vl"][k]);
    d.y = std::max(d.y, std::abs(y - columns["y"][k]));
    d.u = std::max(d.u, std::abs(u - columns["u"][k]));
    if (k < 30) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::string n = std::to_string(j + 1);
      const std::complex<double> expected{columns["ReG" + n][k], columns["ImG" + n][k]};
      d.response = std::max(d.response, std::abs(controller.bank().response()[j] - expected));
    }
    if (k < 80) continue;
    const ac::Rst& rst = controller.rst();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string n = std::to_string(i);
      d.coefficients = std::max({d.coefficients, std::abs(rst.r[i] - columns["r" + n][k]),
                                 std::abs(rst.s[i] - columns["s" + n][k]), std::abs(rst.t[i] - columns["t" + n][k])});
    }
  }
  return d;
}

}  // namespace

TEST_CASE("the base line of example 1 follows the reference run to 1e-8 in every sample") {
  const Differences d = replay("ex1_base_closed_loop.csv", 1e6);
  CHECK(d.y < 1e-8);
  CHECK(d.u < 1e-8);
  CHECK(d.response < 1e-8);
  CHECK(d.coefficients < 1e-6);
}

TEST_CASE("the noisy run of example 1 follows the reference run to 1e-8") {
  const Differences d = replay("ex1_noise_sigma0.05_closed_loop.csv", 1e4);
  CHECK(d.y < 1e-8);
  CHECK(d.u < 1e-8);
  CHECK(d.response < 1e-8);
}

TEST_CASE("a run with gate and bound and ladder and rate limit follows the reference run to 1e-8") {
  auto columns = csv_columns(BODEFLOW_TEST_DATA "/adaptive_control/ex1_safe_run.csv");
  Example e = example_1();
  e.bank.point.p0 = 1e4;
  e.bank.point.forgetting = 0.99;
  e.bank.point.huber = false;
  e.bank.excitation_share = 0.0;
  e.bank.excitation_floor = 1e-3;
  ac::AdaptiveController controller(*ac::EstimatorBank::make(e.bank), *ac::Designer::make(e.design), ac::RstController(), false);
  SimulatedPlant plant(e.plant, e.delay);
  double difference = 0.0;
  for (std::size_t k = 0; k < columns["k"].size(); ++k) {
    const double y = plant.output(), u = controller.step(y, columns["uc"][k]);
    plant.input(u + columns["vl"][k]);
    difference = std::max({difference, std::abs(y - columns["y"][k]), std::abs(u - columns["u"][k])});
  }
  CHECK(columns["k"].size() == 500);
  CHECK(difference < 1e-8);
}

TEST_CASE("other coefficients at rest move nothing: R(1) = 0 and S(1) = T(1)") {
  ac::RstController controller;
  const ac::Coefficients a_ar{1.0, -1.2, 0.4};
  ac::Rst one, two;
  one.n_r = one.n_s = one.n_t = two.n_r = two.n_s = two.n_t = 2;
  one.r = {1.0, -1.1, 0.1}, one.s = {1.2, -1.5, 0.5}, one.t = {1.0, -1.2, 0.4};
  two.r = {1.0, -0.4, -0.6}, two.s = {3.0, -4.0, 1.5}, two.t = {2.0, -2.3, 0.8};
  // Two samples of history at u = 0.7, then y = u_c: the loop is at rest.
  double u = 0.0;
  for (int k = 0; k < 400; ++k) u = controller.step(k < 3 ? 0.0 : 1.0, 1.0, one, a_ar);
  for (int k = 0; k < 50; ++k) CHECK(controller.step(1.0, 1.0, two, a_ar) == Approx(u).epsilon(1e-12));
}

TEST_CASE("a limited control signal does not wind the integrator up") {
  ac::RstController limited(-1.0, 1.0), free;
  const ac::Coefficients a_ar{1.0, -0.5};
  ac::Rst pi;
  pi.n_r = pi.n_s = pi.n_t = 1;
  pi.r = {1.0, -1.0}, pi.s = {1.0, -0.9}, pi.t = {1.0, -0.9};
  for (int k = 0; k < 200; ++k) {
    limited.step(0.0, 1.0, pi, a_ar);
    free.step(0.0, 1.0, pi, a_ar);
  }
  CHECK(limited.saturated());
  CHECK(free.unlimited() == Approx(1.0 + 0.1 * 199));
  CHECK(limited.unlimited() < 2.0);
  int samples = 0;
  while (limited.step(1.5, 1.0, pi, a_ar) >= 1.0 && samples < 100) ++samples;
  CHECK(samples < 3);  // it leaves the limit as soon as the error turns
}

TEST_CASE("a prescribed zero of the controller takes its gain at one frequency away, weights draw the fit to a point") {
  ac::DesignerSettings s = example_1().design;
  s.ladder_steps = 1;
  s.checks = false;
  s.structure.omega = {0.1, 0.3, 0.5, 0.7};
  s.structure.n_r = s.structure.n_s = 3;
  const double notch = 2.0;
  s.structure.s_p = poly({1.0, -2.0 * std::cos(notch), 1.0});
  const Example e = example_1();
  const auto truth = *ac::sampled_response(e.plant, 0.0, 1.0, s.structure.omega);
  auto designer = ac::Designer::make(s);
  REQUIRE(designer);
  designer->step(truth.data());
  const ac::Rst& rst = designer->accepted().rst;
  CHECK(std::abs(ac::value_at(rst.s, rst.n_s, std::polar(1.0, notch))) < 1e-12);
  CHECK(std::abs(ac::value_at(rst.r, rst.n_r, 1.0)) < 1e-12);
  const auto error = [&](const std::vector<double>& weights, std::size_t j) {
    ac::DesignerSettings w = s;
    w.structure.weights = weights;
    auto weighted = ac::Designer::make(w);
    weighted->step(truth.data());
    const ac::RstResult& result = weighted->accepted();
    ac::Rst c = result.rst;
    for (double& t : c.t) t /= result.gain_ratio;  // T as it was fitted
    const std::complex<double> z = std::polar(1.0, s.structure.omega[j]);
    const std::complex<double> r = ac::value_at(c.r, c.n_r, z), sz = ac::value_at(c.s, c.n_s, z), t = ac::value_at(c.t, c.n_t, z);
    const std::complex<double> closed = truth[j] * t / (r + truth[j] * sz);
    return std::abs((closed - weighted->design(0).desired(static_cast<int>(j))) / closed);
  };
  CHECK(error({1, 1, 1, 30}, 3) < 0.2 * error({1, 1, 1, 1}, 3));
}
