#include <cmath>
#include <limits>

#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/maximum_likelihood.hpp"
#include "koopmans_levin/solution.hpp"
#include "koopmans_levin/time_domain.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Records;

TEST_CASE("koopmans_levin: records that cannot be used are refused with what was found") {
  const Eigen::VectorXd ten = Eigen::VectorXd::Ones(10);
  Eigen::VectorXd broken = ten;
  broken[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK(lines_of(ten, ten.head(9)).error().text == "input and output differ in length: 10 and 9 samples");
  CHECK(lines_of(Eigen::VectorXd(), Eigen::VectorXd()).error().text == "the records are empty");
  CHECK(lines_of(broken, ten).error().text == "input: sample 7 is not a finite number");
  CHECK(lines_of(ten, broken).error().text == "output: sample 7 is not a finite number");
  CHECK(time_domain_factors(ten, broken, 1).error().text == "output: sample 7 is not a finite number");
  CHECK(lines_of(ten, ten, Band{2, 10}).error().text == "the band of lines 2 .. 10 is not within 0 .. 9");
  CHECK(lines_of(ten, ten, Band{5, 2}).error().text == "the band of lines 5 .. 2 is not within 0 .. 9");
}

TEST_CASE("koopmans_levin: orders and ratios that cannot be used are refused with what was found") {
  Random random(111);
  const Records r = bodeflow::test::noisy(bodeflow::test::Example1().clean(random, 100), random, 0.1, 6.0);
  const auto lines = lines_of(r.input, r.output, Band{0, 6});
  CHECK(factors(*lines, 0).error().text == "order 0 is not within 1 .. 64");
  CHECK(factors(*lines, 4).error().text ==
        "order 4 needs at least 14 real equations (2 a line, 1 at zero frequency); the band has 13");
  CHECK(factors(*lines, 4, false));
  CHECK(factors_from_sums(*lines, 1).error().text == "sums over lines are exact enough for the full range only");
  const auto f = factors(*lines, 2);
  for (const double ratio : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    CHECK(solve(*f, ratio).error().text == "the noise ratio must be above 0 and finite");
  }
  Model start = *solve(*factors(*lines, 2, false), 6.0);
  CHECK(maximum_likelihood(*lines, start).error().text == "the start needs a transient polynomial");
}

TEST_CASE("koopmans_levin: data that leave several models are refused") {
  Random random(112);
  const Records r = bodeflow::test::Example1().clean(random, 400);
  CHECK(solve(*factors(*lines_of(r.input, r.output), 4), 6.0).error().text ==
        "the data leave more than one model of order 4: lower the order, or excite more lines of the band");
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(100);
  CHECK_FALSE(solve(*factors(*lines_of(zero, zero), 1), 1.0));
  CHECK_FALSE(solve(*factors(*lines_of(Eigen::VectorXd::Ones(100), Eigen::VectorXd::Ones(100)), 2), 1.0));
}
