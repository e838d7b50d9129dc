#include "spectrum/merge.hpp"

#include <bodeflow/numerics/confidence.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>

#include "catch.hpp"
#include "spectrum/weighted_mean.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;

namespace {

/// One input, one output at frequencies from, from + 1, ...: G = 1/(1 + j f/50).
ResponseData truth(double from, Eigen::Index lines, double variance, double nu) {
  ResponseData d;
  d.form = "known_input";
  d.method = "spectrum.averaging_dft";
  d.input_names = {"u"};
  d.output_names = {"y"};
  d.response_units = {"m/N"};
  d.periods = 4;
  d.realisations = 1;
  d.period = 1000;
  d.sample_rate_hz = 1000.0;
  d.degrees_of_freedom = nu;
  d.frequency_hz = Eigen::VectorXd::LinSpaced(lines, from, from + static_cast<double>(lines) - 1.0);
  for (Eigen::Index k = 0; k < lines; ++k) d.lines.push_back(std::lround(d.frequency_hz[k]));
  d.response = (1.0 + Complex(0.0, 0.02) * d.frequency_hz.array()).inverse().matrix();
  d.variance = Eigen::MatrixXd::Constant(lines, 1, variance);
  return d;
}

/// The same measured: circular noise of that variance, and its estimate with nu degrees of freedom.
ResponseData measured(double from, Eigen::Index lines, double variance, int nu, numerics::Random& random) {
  ResponseData d = truth(from, lines, variance, nu);
  for (Eigen::Index k = 0; k < lines; ++k) {
    d.response(k, 0) += std::sqrt(variance / 2.0) * Complex(random.normal(), random.normal());
    double squares = 0.0;
    for (int i = 0; i < 2 * nu; ++i) squares += std::pow(random.normal(), 2) / (2.0 * nu);
    d.variance(k, 0) *= squares;
  }
  return d;
}

}  // namespace

TEST_CASE("merge: inverse-variance weights, and the variance of the mean, by hand") {
  ResponseData a = truth(1.0, 1, 1.0, 4.0), b = truth(1.0, 1, 3.0, 8.0);
  a.response(0, 0) = {1.0, 0.0};
  b.response(0, 0) = {3.0, 2.0};
  const auto m = merge({a, b});
  REQUIRE(m);
  CHECK(std::abs(m->response(0, 0) - Complex(1.5, 0.5)) < 1e-15);
  // Weights 3/4 and 1/4: 1/(1 + 1/3) (1 + 2 * 3/16 (1/4 + 1/8)); nu = 1/(9/16/4 + 1/16/8).
  CHECK(m->variance(0, 0) == Approx(0.75 * (1.0 + 0.375 * 0.375)));
  CHECK(*m->degrees_of_freedom == Approx(1.0 / (9.0 / 64.0 + 1.0 / 128.0)));
  CHECK(m->confidence_radius(0, 0) == Approx(numerics::confidence_radius(m->variance(0, 0), *m->degrees_of_freedom, 0.95)));
  CHECK(m->periods == 8);
  CHECK(m->realisations == 2);
  CHECK(m->form == "known_input");
  CHECK(m->warnings.empty());
}

TEST_CASE("merge: bands are joined in order of frequency, overlapping lines combined") {
  const ResponseData low = truth(1.0, 10, 1e-6, 3.0), high = truth(8.0, 10, 1e-6, 3.0);
  const auto m = merge({high, low});
  REQUIRE(m);
  REQUIRE(m->frequency_hz.size() == 17);
  for (Eigen::Index k = 0; k < 17; ++k) {
    CHECK(m->frequency_hz[k] == static_cast<double>(k + 1));
    CHECK(m->lines[static_cast<std::size_t>(k)] == k + 1);
    CHECK(std::abs(m->response(k, 0) - 1.0 / Complex(1.0, 0.02 * static_cast<double>(k + 1))) < 1e-15);
    const bool both = k >= 7 && k <= 9;
    CHECK(m->variance(k, 0) == Approx(both ? 0.5e-6 * (1.0 + 1.0 / 3.0) : 1e-6));
  }
  CHECK(*m->degrees_of_freedom == Approx(3.0));
}

TEST_CASE("merge: 95 % regions of three merged experiments cover, and agreeing ones are not warned of") {
  const int runs = 100, lines = 100;
  double covered = 0.0, predicted = 0.0, scatter = 0.0;
  int warned = 0;
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(1, static_cast<std::uint64_t>(run));
    const auto m = merge(
        {measured(1.0, lines, 1e-4, 7, random), measured(1.0, lines, 4e-4, 7, random), measured(1.0, lines, 2e-4, 15, random)});
    REQUIRE(m);
    const auto g = truth(1.0, lines, 1.0, 1.0).response;
    for (Eigen::Index k = 0; k < lines; ++k) {
      const double distance = std::abs(m->response(k, 0) - g(k, 0));
      covered += distance <= m->confidence_radius(k, 0) ? 1.0 / (runs * lines) : 0.0;
      predicted += m->variance(k, 0);
      scatter += distance * distance;
    }
    if (!m->warnings.empty()) ++warned;
  }
  INFO("coverage " << covered << ", variance ratio " << predicted / scatter << ", warnings " << warned);
  CHECK(covered > 0.94);
  CHECK(covered < 0.96);
  CHECK(predicted / scatter == Approx(1.0).epsilon(0.05));
  CHECK(warned <= 2);
}

TEST_CASE("merge: an experiment that disagrees beyond chance is named with its lines") {
  numerics::Random random(9);
  std::vector<ResponseData> all;
  for (int e = 0; e < 3; ++e) all.push_back(measured(1.0, 100, 1e-4, 7, random));
  all[1].response.middleRows(40, 20).array() *= 1.12;
  all[1].warnings = {"input 'u' is clipped"};
  const auto m = merge(all);
  REQUIRE(m);
  REQUIRE(m->warnings.size() == 2);
  CHECK(m->warnings[0] == "experiment 2: input 'u' is clipped");
  CHECK(m->warnings[1].find("experiment 2 disagrees with the others beyond chance: ") == 0);
  CHECK(m->warnings[1].find(" of 100 values (chance: 1), most at ") != std::string::npos);
  CHECK(m->warnings[1].find("Hz: the plant or its operating point changed") != std::string::npos);
}

TEST_CASE("merge: the test of agreement has the size that it claims") {
  // Difference of two estimates with 5 and 9 degrees of freedom, variances 1 and 2: below 1 % in 1 % of the cases.
  numerics::Random random(4);
  int below = 0;
  const int runs = 20000;
  for (int run = 0; run < runs; ++run) {
    const auto draw = [&](double variance, int nu) {
      Uncertain u{std::sqrt(variance / 2.0) * Complex(random.normal(), random.normal()), 0.0, static_cast<double>(nu)};
      for (int i = 0; i < 2 * nu; ++i) u.variance += variance * std::pow(random.normal(), 2) / (2.0 * nu);
      return u;
    };
    const Uncertain a = draw(1.0, 5), b = draw(2.0, 9);
    if (agreement(a, b) < 0.01) ++below;
  }
  CHECK(below / static_cast<double>(runs) == Approx(0.01).margin(0.0025));
}

TEST_CASE("merge: exact values stay, and experiments without variance are only joined") {
  ResponseData exact = truth(1.0, 3, 0.0, 3.0), noisy = truth(1.0, 3, 1.0, 3.0);
  noisy.response.array() += 0.5;
  const auto m = merge({noisy, exact});
  REQUIRE(m);
  CHECK(m->response == exact.response);
  CHECK(m->variance.isZero(0.0));
  ResponseData bare = truth(1.0, 3, 1.0, 3.0), above = truth(4.0, 3, 1.0, 3.0);
  bare.variance.resize(0, 0);
  above.variance.resize(0, 0);
  const auto joined = merge({bare, above});
  REQUIRE(joined);
  CHECK(joined->frequency_hz.size() == 6);
  CHECK(joined->variance.size() == 0);
  const auto overlap = merge({bare, bare});
  CHECK(overlap.error().text == "the experiments have no variance and overlap at 1 Hz; give them bands of their own");
}

TEST_CASE("merge: experiments that do not belong together are refused by name") {
  const ResponseData a = truth(1.0, 3, 1.0, 3.0);
  const auto refusal = [&](auto&& change) {
    ResponseData b = a;
    change(b);
    const auto m = merge({a, b});
    return m ? std::string("none") : m.error().text;
  };
  CHECK(refusal([](ResponseData&) {}) == "none");
  CHECK(refusal([](ResponseData& b) { b.output_names = {"speed"}; }) ==
        "experiment 2 has the outputs 'speed', the first one 'y'");
  CHECK(refusal([](ResponseData& b) {
          b.input_names = {"u", "v"};
        }) == "experiment 2 has the inputs 'u', 'v', the first one 'u'");
  CHECK(refusal([](ResponseData& b) { b.response_units = {"mm/N"}; }) ==
        "experiment 2 has the units 'mm/N', the first one 'm/N'");
  CHECK(refusal([](ResponseData& b) { b.variance.resize(0, 0); }) ==
        "experiment 2 has no variance, experiment 1 has one: they cannot be weighed");
  CHECK(merge({}).error().text == "no record to merge; needed: at least one");
}
