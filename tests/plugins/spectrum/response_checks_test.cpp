#include "spectrum/response_checks.hpp"

#include <algorithm>

#include "catch.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

constexpr int kSamples = 256;
using Signal = std::function<double(int, int)>;  // period, sample of the period

const std::vector<std::int64_t> kLines = lines_of(3, 59, 4);

double tone(const std::vector<std::int64_t>& lines, double n, double period = kSamples) {
  double x = 0.0;
  for (const std::int64_t k : lines) x += std::cos(2.0 * M_PI * double(k) * n / period + double(k * k));
  return x;
}

/// The warnings of a measurement of signals u and y.
std::vector<std::string> warnings(int periods, const Signal& u, const Signal& y,
                                  const std::vector<std::int64_t>& lines = kLines) {
  AveragingDft average(kSamples, 1);
  for (int p = 0; p < periods; ++p) {
    Eigen::MatrixXd frame(kSamples, 2);
    for (int n = 0; n < kSamples; ++n) frame.row(n) << u(p, n), y(p, n);
    average.add(frame);
  }
  const Measured m{{1, 1, 0}, kSamples, 1, {*average.moments()}};
  const auto e = estimate_response(m, {lines, 0.0}, Form::errors_in_variables);
  REQUIRE(e);
  const Levels levels = levels_of(m, e->lines, lines.front(), lines.back());
  return response_warnings({m, *e, levels, Form::errors_in_variables, 2.0, {"u", "y"}});
}

using Texts = std::vector<std::string>;

struct Noisy {
  numerics::Random random{1};
  double operator()(double deviation) { return deviation * random.normal(); }
};

}  // namespace

TEST_CASE("checks: a good measurement has no warnings") {
  Noisy e;
  const Signal u = [&](int, int n) { return tone(kLines, n) + e(0.05); },
               y = [&](int, int n) { return 2.0 * tone(kLines, n - 1) + e(0.1); };
  for (int repeat = 0; repeat < 20; ++repeat) CHECK(warnings(6, u, y) == Texts{});
  const Signal exact = [&](int, int n) { return tone(kLines, n); };
  CHECK(warnings(6, exact, exact) == Texts{});
}

TEST_CASE("checks: few periods") {
  Noisy e;
  const Signal u = [&](int, int n) { return tone(kLines, n) + e(0.05); };
  CHECK(warnings(3, u, u) ==
        Texts{"only 3 periods: the variance is itself uncertain, and the 95 % region up to 1.52 times as wide as with "
              "many; measure at least 4"});
  CHECK(warnings(2, u, u).front().substr(0, 90) ==
        "only 2 periods: the variance is itself uncertain, and the 95 % region up to 2.52 times as ");
}

TEST_CASE("checks: a weak input, with the lines") {
  Noisy e;
  const auto strong = lines_of(3, 51, 4);
  const Signal u = [&](int, int n) { return tone(strong, n) + 0.05 * std::cos(2.0 * M_PI * 55 * n / kSamples) + e(0.5); };
  const Signal y = [&](int, int n) { return tone(strong, n) + e(0.5); };
  const Texts found = warnings(8, u, y, lines_of(3, 55, 4));
  REQUIRE(found.size() == 1);
  CHECK(found[0].substr(0, 86) == "the input stands less than 10 dB above its own noise at 1 of 14 lines (110 Hz), at wor");
  CHECK(found[0].find(
            "Hz: the response is biased there; put more amplitude on these lines, average more periods, or leave them out") !=
        std::string::npos);
}

TEST_CASE("checks: a wrong period, with the right one") {
  Noisy e;
  // The true period is 256.05 samples: a clock that runs 0.02 % fast.
  const Signal u = [&](int p, int n) { return tone(kLines, p * kSamples + n, 256.05) + e(0.01); };
  const Texts found = warnings(6, u, u);
  REQUIRE(!found.empty());
  CHECK(found[0].substr(0, 113) ==
        "successive periods turn against each other, by up to 0.0724 rad: the true period is 0.05 samples longer than 256;");
}

TEST_CASE("checks: power beside the excited lines of the input") {
  Noisy e;
  const Signal u = [&](int, int n) { return tone(kLines, n) + 0.1 * tone(lines_of(4, 56, 4), n) + e(0.01); };
  const Signal y = [&](int, int n) { return tone(kLines, n) + e(0.01); };
  const Texts found = warnings(6, u, y);
  REQUIRE(found.size() == 1);
  CHECK(found[0].substr(0, 70) == "the input has 6.71 % of the excited level on the lines beside the exci");
}

TEST_CASE("checks: aliasing, of the excitation and into the output") {
  Noisy e;
  const auto high = lines_of(3, 123, 4);
  const Signal wide = [&](int, int n) { return tone(high, n) + e(0.05); };
  CHECK(warnings(6, wide, wide, high) == Texts{"lines up to 246 Hz are excited, above 0.8 of the Nyquist frequency (256 Hz): "
                                               "what lies above it folds back there; use an "
                                               "anti-alias filter and a higher sample rate"});
  const Signal u = [&](int, int n) { return tone(kLines, n) + e(0.05); };
  const Signal y = [&](int, int n) { return tone(kLines, n) + 0.2 * tone({117, 121, 125}, n) + e(0.05); };
  const Texts found = warnings(6, u, y);
  REQUIRE(found.size() == 1);
  CHECK(found[0].find(
            "of its strongest line right below the Nyquist frequency, where nothing is excited: it is probably aliased") !=
        std::string::npos);
}

TEST_CASE("checks: what the input itself has below the Nyquist frequency is not aliased") {
  Noisy e;
  const auto all = lines_of(1, 127);
  const Signal u = [&](int, int n) { return tone(all, n) + e(0.05); };
  const Signal y = [&](int, int n) { return 0.1 * tone(all, n) + 0.9 * tone(kLines, n) + e(0.05); };
  CHECK(warnings(6, u, y, lines_of(1, 60)) == Texts{});
}

TEST_CASE("checks: an output that is constant") {
  Noisy e;
  const Signal u = [&](int, int n) { return tone(kLines, n) + e(0.05); };
  for (const double level : {0.0, 3.3}) {
    CHECK(warnings(6, u, [&](int, int) { return level; }) ==
          Texts{"output 'y' is constant: its response and variance are zero; is it connected, and is it the right channel?"});
  }
}

TEST_CASE("checks: a reference that is noisy, where the response is taken from it") {
  Noisy e;
  AveragingDft average(kSamples, Layout{1, 1, 1});
  for (int p = 0; p < 6; ++p) {
    Eigen::MatrixXd frame(kSamples, 3);
    for (int n = 0; n < kSamples; ++n) frame.row(n) << tone(kLines, n), tone(kLines, n), tone(kLines, n) + e(20.0);
    average.add(frame);
  }
  const Measured m{{1, 1, 1}, kSamples, 1, {*average.moments()}};
  for (const Form form : {Form::reference, Form::errors_in_variables}) {
    const auto estimate = estimate_response(m, {kLines, 0.0}, form);
    REQUIRE(estimate);
    const Levels levels = levels_of(m, estimate->lines, kLines.front(), kLines.back());
    const Texts found = response_warnings({m, *estimate, levels, form, 2.0, {"u", "y", "r"}});
    const bool told = std::any_of(found.begin(), found.end(), [](const std::string& t) {
      return t.rfind("the reference stands less than 10 dB above its own noise at ", 0) == 0;
    });
    CHECK(told == (form == Form::reference));
  }
}

TEST_CASE("checks: a transient that is not over") {
  Noisy e;
  const Signal u = [&](int, int n) { return tone(kLines, n) + e(0.02); };
  const Signal y = [&](int p, int n) { return tone(kLines, n) + 2.0 * std::exp(-(p * kSamples + n) / 60.0) + e(0.02); };
  const Texts found = warnings(6, u, y);
  REQUIRE(found.size() >= 1);
  CHECK(found[0].substr(0, 50) == "the first averaged period of 'y' differs from the ");
  CHECK(found[0].find("skip more periods, or set transient: remove") != std::string::npos);
}

TEST_CASE("checks: distortion well above the noise, with how many times") {
  Noisy e;
  const Signal u = [&](int, int n) { return tone(kLines, n); };
  const Signal y = [&](int, int n) { return tone(kLines, n) + 0.01 * tone(lines_of(4, 56, 4), n) + e(0.01); };
  const Texts found = warnings(8, u, y);
  REQUIRE(found.size() == 1);
  CHECK(found[0].substr(0, 50) == "output 'y': distortion at unexcited lines is even ");
}

TEST_CASE("checks: how many samples a period is too long, from the turn of its lines") {
  for (const double error : {0.0, 0.3, -0.01, 1e-4}) {
    AveragingDft average(kSamples, 1);
    for (int p = 0; p < 5; ++p) {
      Eigen::VectorXd x(kSamples);
      for (int n = 0; n < kSamples; ++n) x[n] = tone(kLines, p * kSamples + n, kSamples + error);
      average.add(x, x);
    }
    const PeriodError found = period_error(*average.moments(), 0, kLines, kSamples);
    CHECK(found.samples == Approx(error).epsilon(0.02).margin(1e-10));
  }
}
