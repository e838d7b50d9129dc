// Warnings about what should repeat from period to period and does not, and what should not from realisation to realisation.

#include <algorithm>

#include "catch.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"
#include "spectrum/response_checks.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

constexpr int kSamples = 128;
const std::vector<std::int64_t> kLines = lines_of(1, 39, 2);
using Texts = std::vector<std::string>;

/// lines: empty for those above a threshold of 0.3.
Texts warnings(const Measured& m, const std::vector<std::int64_t>& lines) {
  const auto e = estimate_response(m, {lines, lines.empty() ? 0.3 : 0.0}, Form::errors_in_variables);
  REQUIRE(e);
  const Levels levels = levels_of(m, e->lines, e->lines.front(), e->lines.back());
  return response_warnings({m, *e, levels, Form::errors_in_variables, 2.0, {"u", "y"}, lines.empty()});
}

/// 7 realisations of 3 periods of y = u + 0.2 u^3 + noise; every `repeat` of them have the same phases.
Texts realisations(int repeat, double deviation, numerics::Random& random, const std::vector<std::int64_t>& lines = kLines) {
  Measured m{{1, 1, 0}, kSamples, 1, {}};
  Eigen::VectorXd u;
  for (int r = 0; r < 7; ++r) {
    if (r % repeat == 0) u = random_multisine(kSamples, lines, 0.3, random);
    AveragingDft average(kSamples, 1);
    for (int p = 0; p < 3; ++p) {
      average.add(u + noise(kSamples, 0.1 * deviation, random),
                  u + 0.2 * u.cwiseProduct(u).cwiseProduct(u) + noise(kSamples, deviation, random));
    }
    m.parts.push_back(*average.moments());
  }
  return warnings(m, lines);
}

std::string repeated(int count) {
  return std::to_string(count) +
         " of 7 realisations have the excitation of the first or of the one before: nonlinear distortion repeats with it, and "
         "neither variance nor nonlinear_variance holds it; give each realisation phases of its own (phases: random)";
}

bool tells(const Texts& texts, const std::string& text) { return std::find(texts.begin(), texts.end(), text) != texts.end(); }

/// `periods` of a multisine with noise, the output drifting by `rise` from each period to the next.
Measured drifting(int periods, double rise, double input_rise, numerics::Random& random,
                  AveragingDft::Detrend detrend = AveragingDft::Detrend::none) {
  const Eigen::VectorXd u = random_multisine(kSamples, kLines, 0.3, random);
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(kSamples, 0.0, double(kSamples - 1) / kSamples);
  AveragingDft average(kSamples, Layout{1, 1, 0}, detrend);
  for (int p = 0; p < periods; ++p) {
    average.add(u + noise(kSamples, 0.02, random) + input_rise * (ramp.array() + p).matrix(),
                u + noise(kSamples, 0.05, random) + rise * (ramp.array() + p).matrix());
  }
  return Measured{{1, 1, 0}, kSamples, 1, {*average.moments()}};
}

bool warns_of_drift(const Texts& texts) {
  return std::any_of(texts.begin(), texts.end(),
                     [](const std::string& t) { return t.find("' drifts by ") != std::string::npos; });
}

}  // namespace

TEST_CASE("checks: realisations that repeat their phases are told, random ones are not") {
  numerics::Random random(4);
  for (const double deviation : {0.0, 0.01, 0.3}) {
    CAPTURE(deviation);
    CHECK(tells(realisations(7, deviation, random), repeated(6)));
    CHECK(tells(realisations(2, deviation, random), repeated(3)));
  }
  for (int repeat = 0; repeat < 100; ++repeat) {
    const auto lines = lines_of(1, repeat % 2 == 0 ? 39 : 5, 2);
    for (const std::string& text : realisations(1, repeat % 3 == 0 ? 0.0 : 0.1, random, lines)) {
      CHECK(text.find("realisations have") == std::string::npos);
    }
  }
}

TEST_CASE("checks: a drift is told from the means of the periods, with its size") {
  numerics::Random random(7);
  for (const int periods : {4, 9, 30}) {
    const Texts found = warnings(drifting(periods, 1.0, 0.0, random), kLines);
    REQUIRE(found.size() == 1);  // the ramp on the unexcited lines is neither distortion nor aliasing
    const std::string expected = "output 'y' drifts by ";
    CHECK(found[0].substr(0, expected.size()) == expected);
    CHECK(std::stod(found[0].substr(expected.size())) == Approx(periods).epsilon(0.01));
    CHECK(found[0].find(" over the " + std::to_string(periods) + " averaged periods, which shifts the response at the lowest " +
                        "lines by up to ") != std::string::npos);
    CHECK(found[0].find(" times the confidence radius: set detrend: linear") != std::string::npos);
    CHECK(warnings(drifting(periods, 1.0, 0.0, random, AveragingDft::Detrend::linear), kLines) == Texts{});
    CHECK(warnings(drifting(periods, 0.0, -0.5, random), kLines).at(0).substr(0, 20) == "input 'u' drifts by ");
  }
}

TEST_CASE("checks: a drift is told as soon as it shifts the lowest line by a confidence radius, and noise is no drift") {
  // A drift of b a period shifts line 1 by b / (2 pi |U|); |U| = 0.15, the variance of y - u sets the radius.
  numerics::Random random(8);
  const double variance = (0.05 * 0.05 + 0.02 * 0.02) / kSamples / 0.15 / 0.15;
  for (const int periods : {6, 10, 20}) {
    const double radius = std::sqrt(3.0 * variance / periods);
    int told = 0, false_alarms = 0, small = 0;
    for (int repeat = 0; repeat < 100; ++repeat) {
      told += warns_of_drift(warnings(drifting(periods, 2.0 * radius * 2.0 * M_PI * 0.15, 0.0, random), kLines)) ? 1 : 0;
      small += warns_of_drift(warnings(drifting(periods, 0.1 * radius * 2.0 * M_PI * 0.15, 0.0, random), kLines)) ? 1 : 0;
    }
    for (int repeat = 0; repeat < 300; ++repeat) {
      false_alarms += warns_of_drift(warnings(drifting(periods, 0.0, 0.0, random), kLines)) ? 1 : 0;
    }
    CAPTURE(periods);
    CHECK(told >= 95);
    CHECK(small <= 1);
    CHECK(false_alarms == 0);
  }
  for (int repeat = 0; repeat < 300; ++repeat) {
    CHECK_FALSE(warns_of_drift(warnings(drifting(3 + repeat % 3, 0.0, 0.0, random), kLines)));
  }
}

TEST_CASE("checks: rounding of exact data is neither noise nor distortion") {
  numerics::Random random(9);
  Measured linear{{1, 1, 0}, kSamples, 1, {}}, cubic = linear;
  for (int r = 0; r < 7; ++r) {
    const Eigen::VectorXd u = random_multisine(kSamples, kLines, 0.3, random);
    AveragingDft one(kSamples, 1), other(kSamples, 1);
    for (int p = 0; p < 4; ++p) {
      one.add(u, 0.7 * u);
      other.add(u, u + 0.2 * u.cwiseProduct(u).cwiseProduct(u));
    }
    linear.parts.push_back(*one.moments());
    cubic.parts.push_back(*other.moments());
  }
  CHECK(warnings(linear, kLines) == Texts{});
  // Lines of u^3 above the Nyquist frequency fold back: that is told of as well.
  const Texts found = warnings(cubic, kLines);
  CAPTURE(found);
  REQUIRE(!found.empty());
  CHECK(found.back().substr(0, 40) == "stochastic nonlinear distortion is 7.04 ");
  CHECK(found.back().substr(40) ==
        "% of the response in the mean of the realisations, and there is no noise: measure more realisations, or with another "
        "amplitude");
}

TEST_CASE("checks: periods that do not repeat, of a period that is not that of the excitation") {
  const auto measured = [](int period, double deviation) {
    numerics::Random random(10);
    const Eigen::VectorXd u = random_multisine(500, lines_of(1, 99), 0.2, random);
    AveragingDft average(period, 1);
    for (int p = 0; p < 4500 / period; ++p) {
      Eigen::VectorXd x(period);
      for (int n = 0; n < period; ++n) x[n] = u[(p * period + n) % 500];
      average.add(x + noise(period, 0.1 * deviation, random), x + noise(period, deviation, random));
    }
    return Measured{{1, 1, 0}, period, 1, {*average.moments()}};
  };
  const auto first = [&](int period, const char* of) {
    for (const double deviation : {1e-4, 0.03}) {
      const Texts found = warnings(measured(period, deviation), {});
      CAPTURE(period, deviation, found);
      CHECK(std::any_of(found.begin(), found.end(), [&](const std::string& text) {
        return text.rfind("the periods of the input do not repeat: ", 0) == 0 &&
               text.find(" % of its power changes from one period of " + std::to_string(period) + " samples to the next, and " +
                         of + "; give the period of the excitation or a multiple of it, and a start after its transient") !=
                   std::string::npos;
      }));
    }
  };
  first(250, "40 of 50 lines with power are kept");
  first(400, "19 of 82 lines with power are kept");
  CHECK(warnings(measured(500, 0.01), {}) == Texts{});
  CHECK(warnings(measured(1000, 0.01), {}) == Texts{});
}

TEST_CASE("checks: white noise on the input is no wrong period") {
  numerics::Random random(11);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Eigen::VectorXd u = random_multisine(kSamples, kLines, 0.3, random);
    AveragingDft average(kSamples, 1);
    for (int p = 0; p < 40; ++p) average.add(u + noise(kSamples, 0.8, random), u + noise(kSamples, 0.5, random));
    for (const auto& lines : {kLines, std::vector<std::int64_t>{}}) {
      for (const std::string& text : warnings(Measured{{1, 1, 0}, kSamples, 1, {*average.moments()}}, lines)) {
        CHECK(text.find("do not repeat") == std::string::npos);
        CHECK(text.find("left out") == std::string::npos);
      }
    }
  }
}

TEST_CASE("checks: lines that carry power and that the threshold leaves out") {
  numerics::Random random(12);
  const Eigen::VectorXd u =
      random_multisine(kSamples, lines_of(1, 19, 2), 0.3, random) + random_multisine(kSamples, lines_of(21, 39, 2), 0.06, random);
  AveragingDft average(kSamples, 1);
  for (int p = 0; p < 6; ++p) average.add(u + noise(kSamples, 0.001, random), u + noise(kSamples, 0.01, random));
  const Measured m{{1, 1, 0}, kSamples, 1, {*average.moments()}};
  CHECK(warnings(m, {}) == Texts{"10 lines of the input with a tenth of the strongest or more are left out, the first at 42 Hz: "
                                 "name the lines, or set lines.threshold lower, if they are excited"});
  CHECK(warnings(m, kLines) == Texts{});
}
