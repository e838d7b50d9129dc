#include "koopmans_levin/decorrelated_noise.hpp"

#include <cmath>

#include "catch.hpp"
#include "examples.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;

TEST_CASE("koopmans_levin: decorrelated noise has mean, variance and correlations exactly") {
  Random random(301);
  const auto clean = bodeflow::test::Example1().clean(random, 400);
  const auto noise = decorrelated_noise(clean.input, clean.output, 0.1, 0.6, random);
  REQUIRE(noise);
  CHECK(noise->input.squaredNorm() / 400.0 == Approx(0.1).epsilon(1e-12));
  CHECK(noise->output.squaredNorm() / 400.0 == Approx(0.6).epsilon(1e-12));
  for (const Eigen::VectorXd& v : {noise->input, noise->output}) {
    CHECK(std::abs(v.mean()) < 1e-13);
    CHECK(std::abs(v.dot(clean.input)) < 1e-10);
    CHECK(std::abs(v.dot(clean.output)) < 1e-10);
  }
  CHECK(std::abs(noise->input.dot(noise->output)) < 1e-10);
  // White otherwise: the neighbours' correlation of 400 samples scatters by 1/20.
  CHECK(std::abs(noise->input.head(399).dot(noise->input.tail(399))) < 4.0 * 0.1 * 20.0);
}

TEST_CASE("koopmans_levin: decorrelated noise copes with signals that are constant or alike") {
  Random random(302);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(50);
  const auto noise = decorrelated_noise(one, 2.0 * one, 1.0, 4.0, random);
  REQUIRE(noise);
  CHECK(noise->output.squaredNorm() / 50.0 == Approx(4.0));
  CHECK(decorrelated_noise(one, one.head(49), 1.0, 1.0, random).error().text ==
        "decorrelated noise needs signals of equal length, at least 8 samples; found 50 and 49");
  CHECK(decorrelated_noise(one, one, -1.0, 1.0, random).error().text == "a variance must be at least 0 and finite");
}
