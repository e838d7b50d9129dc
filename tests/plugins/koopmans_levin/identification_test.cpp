// Order, ratio and refinement together.

#include "koopmans_levin/identification.hpp"

#include <Eigen/Dense>

#include "catch.hpp"
#include "examples.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Records;

TEST_CASE("koopmans_levin: a refined model with estimated ratio scatters as its covariance says") {
  const Example1 system;
  Random random(201);
  constexpr int kRuns = 40;
  const Records clean = system.clean(random, 1500);
  Settings s;
  s.order = 2;
  s.refine = true;
  Eigen::VectorXd truth(5);
  truth << system.a.tail(2), system.b;
  Eigen::VectorXd square = Eigen::VectorXd::Zero(5), predicted = square;
  int used = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto found = identify(r.input, r.output, s);
    if (!found) continue;  // not determined
    ++used;
    square += (parameters(found->model) - truth).cwiseAbs2();
    predicted += found->covariance.diagonal();
  }
  CAPTURE(used, square.cwiseQuotient(predicted).transpose());
  CHECK(used >= 36);
  for (Eigen::Index i = 0; i < 5; ++i) CHECK(square[i] / predicted[i] == Approx(1.0).margin(0.7));  // 40 runs: 22 %
}

TEST_CASE("koopmans_levin: order and ratio sought together are those of the system") {
  const Example1 system;
  Random random(202);
  int right = 0;
  for (int run = 0; run < 10; ++run) {
    const Records r = bodeflow::test::noisy(system.clean(random, 4000), random, system.input_noise, system.ratio);
    const auto found = identify(r.input, r.output, Settings{});
    REQUIRE(found);
    right += found->model.order() == 2 ? 1 : 0;
  }
  CHECK(right >= 9);
}

TEST_CASE("koopmans_levin: the full range in both routes is the same model with the same covariance") {
  const Example1 system;
  Random random(203);
  const Records r = bodeflow::test::noisy(system.clean(random, 700), random, system.input_noise, system.ratio);
  Settings s;
  s.order = 2;
  s.ratio = 6.0;
  const auto frequency = identify(r.input, r.output, s);
  s.route = Route::time_domain;
  const auto time = identify(r.input, r.output, s);
  REQUIRE(frequency);
  REQUIRE(time);
  CHECK((parameters(frequency->model) - parameters(time->model)).norm() < 1e-10);
  CHECK((frequency->covariance - time->covariance).norm() < 1e-8 * frequency->covariance.norm());
  CHECK(std::abs(frequency->model.noise - time->model.noise) < 1e-12);
}

TEST_CASE("koopmans_levin: settings that contradict each other are refused") {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(100, -1.0, 1.0);
  Settings s;
  s.order = 1;
  s.ratio = 1.0;
  s.transient = false;
  s.refine = true;
  CHECK(identify(x, x, s).error().text == "refine: maximum_likelihood needs transient: true");
  s.refine = false;
  s.route = Route::time_domain;
  CHECK(identify(x, x, s).error().text == "route: time_domain needs transient: true, which is part of it");
}
