#include "koopmans_levin/unknown_ratio.hpp"

#include <Eigen/Dense>

#include "catch.hpp"
#include "examples.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Example2;
using bodeflow::test::Records;

TEST_CASE("koopmans_levin: covariance matching finds the ratio of Example 1 with the scatter it states") {
  const Example1 system;
  Random random(71);
  constexpr int kRuns = 40;
  const Records clean = system.clean(random, 3000);
  double mean = 0.0, square = 0.0, predicted = 0.0, b2_square = 0.0, b2_predicted = 0.0;
  int determined = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto lines = lines_of(r.input, r.output);
    const auto e = ratio_by_covariance_matching(*lines, *factors(*lines, 2));
    REQUIRE(e);
    determined += e->determined ? 1 : 0;
    if (!e->determined) continue;
    const double error = std::log(e->ratio / system.ratio);
    mean += error;
    square += error * error;
    predicted += e->log_ratio_std * e->log_ratio_std;
    b2_square += std::pow(e->solution.b[2] - system.b[2], 2);
    b2_predicted += e->covariance(4, 4);
  }
  CAPTURE(determined, mean / kRuns, std::sqrt(square / kRuns), std::sqrt(predicted / kRuns), std::sqrt(b2_square / kRuns),
          std::sqrt(b2_predicted / kRuns));
  CHECK(determined >= 39);
  CHECK(std::abs(mean / determined) < 4.0 * std::sqrt(square / kRuns / kRuns) + 0.02);
  CHECK(square / predicted == Approx(1.0).margin(0.7));  // 40 runs give a variance to 22 %
  CHECK(b2_square / b2_predicted == Approx(1.0).margin(0.7));
}

TEST_CASE("koopmans_levin: the ratio is declared not determined where the data do not tell it") {
  const Example1 system;
  Random random(72);
  SECTION("too few samples") {
    int determined = 0;
    for (int run = 0; run < 20; ++run) {
      const Records r = bodeflow::test::noisy(system.clean(random, 60), random, system.input_noise, system.ratio);
      const auto lines = lines_of(r.input, r.output);
      const auto e = ratio_by_covariance_matching(*lines, *factors(*lines, 2));
      REQUIRE(e);
      determined += e->determined ? 1 : 0;
      if (!e->determined) CHECK(e->reason.rfind("the noise ratio is not determined: ", 0) == 0);
    }
    CHECK(determined <= 6);
  }
  SECTION("lags too short for a band") {
    const Example2 narrow;
    int determined = 0;
    for (int run = 0; run < 10; ++run) {
      const Records r = bodeflow::test::noisy(narrow.clean(random, 2000), random, narrow.input_noise, narrow.ratio);
      const auto lines = lines_of(r.input, r.output, Band{0, 199});
      const auto e = ratio_by_covariance_matching(*lines, *factors(*lines, 4), 2);
      REQUIRE(e);
      determined += e->determined ? 1 : 0;
    }
    CHECK(determined <= 2);
  }
}

TEST_CASE("koopmans_levin: in a band with enough lags the median ratio is near the true one") {
  const Example2 system;
  Random random(73);
  std::vector<double> ratios;
  int determined = 0;
  for (int run = 0; run < 20; ++run) {
    const Records r = bodeflow::test::noisy(system.clean(random, 2000), random, system.input_noise, system.ratio);
    const auto lines = lines_of(r.input, r.output, Band{0, 199});
    const auto e = ratio_by_covariance_matching(*lines, *factors(*lines, 4));
    REQUIRE(e);
    CHECK(e->lags == 16);
    ratios.push_back(e->ratio);
    determined += e->determined ? 1 : 0;
  }
  std::sort(ratios.begin(), ratios.end());
  CAPTURE(ratios, determined);
  CHECK(ratios[10] > 3.0);
  CHECK(ratios[10] < 12.0);
}

TEST_CASE("koopmans_levin: a measured output noise fixes the ratio of a band") {
  const Example2 system;
  Random random(74);
  constexpr int kRuns = 30;
  double square = 0.0, predicted = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(system.clean(random, 2000), random, system.input_noise, system.ratio);
    const auto empty = lines_of(r.input, r.output, Band{640, 1000});  // from 2 rad/sample the response is below 1e-3
    const double floor = noise_floor(empty->output);
    const auto lines = lines_of(r.input, r.output, Band{0, 199});
    const auto e = ratio_from_output_noise(*lines, *factors(*lines, 4), floor, floor / std::sqrt(361.0));
    REQUIRE(e);
    REQUIRE(e->determined);
    CHECK(e->ratio * e->solution.noise_unbiased == Approx(floor).epsilon(1e-9));
    square += std::pow(std::log(e->ratio / system.ratio), 2);
    predicted += std::pow(e->log_ratio_std, 2);
  }
  CAPTURE(std::sqrt(square / kRuns), std::sqrt(predicted / kRuns));
  CHECK(square / predicted == Approx(1.0).margin(0.8));  // 30 runs give a variance to 26 %
  CHECK(std::sqrt(square / kRuns) < 0.25);
}

TEST_CASE("koopmans_levin: an output noise that no ratio gives is not determined") {
  Random random(75);
  const Example1 system;
  const Records r = bodeflow::test::noisy(system.clean(random, 500), random, system.input_noise, system.ratio);
  const auto lines = lines_of(r.input, r.output);
  const auto f = factors(*lines, 2);
  const auto above = ratio_from_output_noise(*lines, *f, 50.0);
  REQUIRE(above);
  CHECK_FALSE(above->determined);
  CHECK(above->reason == "the noise ratio is not determined: the output noise given is greater than the record allows");
  CHECK(ratio_from_output_noise(*lines, *f, -1.0).error().text == "the output noise variance must be above 0 and finite");
}
