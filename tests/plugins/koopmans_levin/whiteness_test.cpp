#include "koopmans_levin/whiteness.hpp"

#include "catch.hpp"
#include "examples.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Records;

namespace {

Whiteness tested(const Records& r, double ratio) {
  const auto lines = lines_of(r.input, r.output);
  const auto s = solve(*factors(*lines, 2), ratio);
  REQUIRE(s);
  const auto w = whiteness(*lines, *s);
  REQUIRE(w);
  return *w;
}

}  // namespace

TEST_CASE("koopmans_levin: under white noise the band statistic is chi-squared with 19 degrees of freedom") {
  const Example1 system;
  Random random(81);
  constexpr int kRuns = 400;
  const Records clean = system.clean(random, 2000);
  double mean = 0.0;
  int below_5_percent = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Whiteness w = tested(bodeflow::test::noisy(clean, random, system.input_noise, system.ratio), system.ratio);
    CHECK(w.degrees_of_freedom == 19.0);
    mean += w.statistic / kRuns;
    below_5_percent += w.probability < 0.05 ? 1 : 0;
  }
  CAPTURE(mean, below_5_percent);
  CHECK(mean == Approx(19.0).margin(1.5));  // the parameters take up some
  CHECK(below_5_percent < 36);              // 20 expected, deviation 4.4
}

TEST_CASE("koopmans_levin: coloured output noise fails the whiteness test") {
  const Example1 system;
  Random random(82);
  const Records clean = system.clean(random, 2000);
  int found = 0;
  for (int run = 0; run < 20; ++run) {
    Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const Eigen::VectorXd coloured = bodeflow::test::filtered(Eigen::VectorXd::Ones(1), Eigen::Vector2d(1.0, -0.5),
                                                              bodeflow::test::white(random, 2000, 0.6 * 0.75));
    r.output = clean.output + coloured;
    found += tested(r, system.ratio).probability < 0.01 ? 1 : 0;
  }
  CHECK(found >= 19);
}

TEST_CASE("koopmans_levin: whiteness needs lines enough for its bands") {
  Random random(83);
  const Records r = bodeflow::test::noisy(Example1().clean(random, 60), random, 0.1, 6.0);
  const auto lines = lines_of(r.input, r.output);
  const auto s = solve(*factors(*lines, 2), 6.0);
  CHECK(whiteness(*lines, *s).error().text ==
        "the whiteness test needs at least 2 bands of at least 5 lines; found 20 bands of 29 lines in all");
  CHECK(whiteness(*lines, *s, 4));
}
