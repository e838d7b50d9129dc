#include "koopmans_levin/maximum_likelihood.hpp"

#include <Eigen/Dense>

#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/influence.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Records;

TEST_CASE("koopmans_levin: maximum likelihood scatters less than Koopmans-Levin, and both as they predict") {
  const Example1 system;
  Random random(51);
  constexpr int kRuns = 120;
  const Records clean = system.clean(random, 1000);
  Eigen::VectorXd truth(5);
  truth << system.a.tail(2), system.b;
  Eigen::ArrayXd kl_squares = Eigen::ArrayXd::Zero(5), ml_squares = kl_squares, kl_predicted = kl_squares,
                 ml_predicted = kl_squares;
  Eigen::ArrayXd kl_inside = kl_squares, ml_inside = kl_squares;
  double noise = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto lines = lines_of(r.input, r.output);
    const auto f = factors(*lines, 2);
    const auto kl = solve(*f, system.ratio);
    const Eigen::MatrixXd kl_covariance = *covariance(*lines, *f, *kl);
    const auto ml = maximum_likelihood(*lines, *kl);
    REQUIRE(ml);
    REQUIRE(ml->converged);
    const Eigen::ArrayXd kl_error = parameters(*kl) - truth, ml_error = parameters(ml->model) - truth;
    const Eigen::ArrayXd kl_variance = kl_covariance.diagonal().head(5), ml_variance = ml->covariance.diagonal();
    kl_squares += kl_error.square() / kRuns;
    ml_squares += ml_error.square() / kRuns;
    kl_predicted += kl_variance / kRuns;
    ml_predicted += ml_variance / kRuns;
    kl_inside += (kl_error.square() < 3.84 * kl_variance).cast<double>() / kRuns;
    ml_inside += (ml_error.square() < 3.84 * ml_variance).cast<double>() / kRuns;
    noise += ml->model.noise_unbiased / kRuns;
  }
  CAPTURE(kl_squares.sqrt().transpose(), kl_predicted.sqrt().transpose(), ml_squares.sqrt().transpose(),
          ml_predicted.sqrt().transpose(), kl_inside.transpose(), ml_inside.transpose(), noise);
  // 120 runs give a variance to 13 %.
  CHECK((kl_squares / kl_predicted - 1.0).abs().maxCoeff() < 0.5);
  CHECK((ml_squares / ml_predicted - 1.0).abs().maxCoeff() < 0.5);
  CHECK(kl_inside.minCoeff() > 0.88);
  CHECK(ml_inside.minCoeff() > 0.88);
  CHECK(ml_squares[0] < 0.75 * kl_squares[0]);
  CHECK(ml_squares[1] < 0.6 * kl_squares[1]);
  CHECK(ml_squares[4] < 0.65 * kl_squares[4]);
  CHECK(noise == Approx(0.1).epsilon(0.02));
}

TEST_CASE("koopmans_levin: maximum likelihood keeps a system without noise") {
  const Example1 system;
  Random random(52);
  const Records r = system.clean(random, 300);
  const auto lines = lines_of(r.input, r.output);
  auto start = *solve(*factors(*lines, 2), system.ratio);
  start.a[1] += 0.05;
  start.b[0] -= 0.1;
  const auto ml = maximum_likelihood(*lines, start);
  REQUIRE(ml);
  CHECK((ml->model.a - system.a).norm() < 1e-9);
  CHECK((ml->model.b - system.b).norm() < 1e-9);
  CHECK(ml->cost < 1e-18);
}
