#include <Eigen/Dense>

#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/influence.hpp"
#include "koopmans_levin/ratio_sensitivity.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Example2;
using bodeflow::test::Records;

TEST_CASE("koopmans_levin: the covariance of a band with its own noise matrix matches the scatter") {
  const Example1 system;
  Random random(61);
  constexpr int kRuns = 300;
  const Records clean = system.clean(random, 2000);
  Eigen::VectorXd truth(6);
  truth << system.a.tail(2), system.b, system.input_noise;
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(6, 6), predicted = scatter;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto lines = lines_of(r.input, r.output, Band{50, 700});
    const auto f = factors(*lines, 2);
    const auto s = solve(*f, system.ratio);
    Eigen::VectorXd error(6);
    error << parameters(*s), s->noise_unbiased;
    error -= truth;
    scatter += error * error.transpose() / kRuns;
    predicted += *covariance(*lines, *f, *s) / kRuns;
  }
  const Eigen::ArrayXd ratios = scatter.diagonal().array() / predicted.diagonal().array();
  CAPTURE(scatter, predicted, ratios.transpose());
  CHECK((ratios - 1.0).abs().maxCoeff() < 0.35);  // 300 runs: 8 % each
  const Eigen::VectorXd scale = predicted.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd difference = scale.asDiagonal() * (scatter - predicted) * scale.asDiagonal();
  CHECK(difference.cwiseAbs().maxCoeff() < 0.35);
}

TEST_CASE("koopmans_levin: the noise variance is unbiased after the correction, in the full range and in a band") {
  const Example1 system;
  Random random(62);
  const Records clean = system.clean(random, 200);
  double full = 0.0, band = 0.0, raw = 0.0;
  constexpr int kRuns = 1000;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto all = solve(*factors(*lines_of(r.input, r.output), 2), system.ratio);
    raw += all->noise / kRuns;
    full += all->noise_unbiased / kRuns;
    band += solve(*factors(*lines_of(r.input, r.output, Band{5, 60}), 2), system.ratio)->noise_unbiased / kRuns;
  }
  CAPTURE(raw, full, band);
  // One run scatters by 11 and 20 %, so the means by .35 and .6 %.
  CHECK(full == Approx(0.1).epsilon(0.011));
  CHECK(band == Approx(0.1).epsilon(0.02));
  CHECK(raw == Approx(0.1 * (1.0 - 7.0 / 200.0)).epsilon(0.011));
}

TEST_CASE("koopmans_levin: a factor 2 in the ratio is warned of where it moves an estimate by more than one standard deviation") {
  const Example1 system;
  Random random(63);
  const Records r = bodeflow::test::noisy(system.clean(random, 1000), random, system.input_noise, system.ratio);
  const auto lines = lines_of(r.input, r.output);
  const auto f = factors(*lines, 2);
  const auto s = solve(*f, system.ratio);
  const auto sensitivity = ratio_sensitivity(*f, *s, *covariance(*lines, *f, *s));
  REQUIRE(sensitivity);
  CAPTURE(sensitivity->shift.transpose(), sensitivity->shift_in_std.transpose());
  CHECK(std::abs(sensitivity->shift[1]) == Approx(0.06).margin(0.025));  // a2 at ratios 3 and 12: .240 and .352 around .301
  CHECK(sensitivity->shift_in_std[1] > 1.0);
  REQUIRE_FALSE(sensitivity->warnings.empty());
  bool names_a2 = false;
  for (const auto& w : sensitivity->warnings) names_a2 = names_a2 || w.find("the noise ratio moves a2 by") != std::string::npos;
  CHECK(names_a2);
  // Nearly without noise the ratio hardly matters: nothing moves beside what little scatter there is left of the input noise
  // bias.
  const Records quiet = bodeflow::test::noisy(system.clean(random, 1000), random, 1e-10, system.ratio);
  const auto quiet_lines = lines_of(quiet.input, quiet.output);
  const auto quiet_factors = factors(*quiet_lines, 2);
  const auto quiet_solution = solve(*quiet_factors, system.ratio);
  const auto none =
      ratio_sensitivity(*quiet_factors, *quiet_solution, *covariance(*quiet_lines, *quiet_factors, *quiet_solution));
  CHECK(none->warnings.empty());
}

TEST_CASE("koopmans_levin: no covariance is given for the printed noise matrix of a band") {
  Random random(64);
  const Records r = bodeflow::test::noisy(Example2().clean(random, 500), random, 0.1, 6.0);
  const auto lines = lines_of(r.input, r.output, Band{0, 99});
  const auto f = factors(*lines, 4);
  const auto s = solve(*f, 6.0, NoiseMatrix::identity);
  CHECK(covariance(*lines, *f, *s).error().text ==
        "with the identity as noise matrix of a band the estimate has a bias and no covariance is right");
}
