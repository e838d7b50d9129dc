#include "report/bode.hpp"

#include <cmath>

#include "catch.hpp"

using namespace bodeflow::tools::report;

namespace {

Record response_of(std::vector<double> re, std::vector<double> im, std::vector<double> radius) {
  Record record;
  record.key = "r";
  record.type = "frequency_response";
  std::vector<double> frequency;
  for (std::size_t k = 0; k < re.size(); ++k) frequency.push_back(static_cast<double>(k + 1));
  const std::uint64_t n = re.size();
  record.arrays = {{"frequency", {"Hz", {n}, frequency, {}}},
                   {"response", {"", {n, 1, 1}, std::move(re), std::move(im)}},
                   {"confidence_radius", {"", {n, 1, 1}, std::move(radius), {}}}};
  return record;
}

}  // namespace

TEST_CASE("report Bode plot: the bounds are those of the confidence circle in magnitude and phase") {
  const Record record = response_of({2.0, 0.0}, {0.0, 1.0}, {1.0, 0.5});
  const BodeCurve curve = bode_curve(*read_response(record), 0, 0);
  CHECK(curve.magnitude.y[0] == Approx(20.0 * std::log10(2.0)));
  CHECK(curve.magnitude.low[0] == Approx(0.0).margin(1e-12));
  CHECK(curve.magnitude.high[0] == Approx(20.0 * std::log10(3.0)));
  CHECK(curve.phase.y[1] == Approx(90.0));
  CHECK(curve.phase.low[1] == Approx(60.0));
  CHECK(curve.phase.high[1] == Approx(120.0));
}

TEST_CASE("report Bode plot: where the circle holds zero the magnitude has no lower bound and the phase is a gap") {
  const Record record = response_of({1.0, 0.1, 1.0}, {0.0, 0.0, 0.0}, {0.1, 0.2, 0.1});
  const BodeCurve curve = bode_curve(*read_response(record), 0, 0);
  CHECK(curve.magnitude.low[1] == -HUGE_VAL);
  CHECK(curve.magnitude.high[1] == Approx(20.0 * std::log10(0.3)));
  CHECK(std::isnan(curve.phase.y[1]));
  CHECK(curve.phase.y[2] == Approx(0.0).margin(1e-12));
}

TEST_CASE("report Bode plot: a response of exactly zero and one that is missing are gaps") {
  const Record record = response_of({0.0, std::nan(""), 1.0}, {0.0, 0.0, 0.0}, {0.1, 0.1, 0.1});
  const BodeCurve curve = bode_curve(*read_response(record), 0, 0);
  CHECK(std::isnan(curve.magnitude.y[0]));
  CHECK(std::isnan(curve.magnitude.y[1]));
  CHECK(std::isfinite(curve.magnitude.y[2]));
}

TEST_CASE("report Bode plot: a delay's phase falls on without jumps") {
  std::vector<double> re, im;
  for (int k = 1; k <= 50; ++k) {
    re.push_back(std::cos(-0.8 * k));
    im.push_back(std::sin(-0.8 * k));
  }
  const Record record = response_of(re, im, std::vector<double>(50, 0.01));
  const BodeCurve curve = bode_curve(*read_response(record), 0, 0);
  CHECK(curve.phase.y.back() == Approx(-0.8 * 50 * 180.0 / M_PI));
}

TEST_CASE("report Bode plot: one chart an input, with up to four outputs in it") {
  Record record;
  record.key = "r";
  record.type = "frequency_response";
  record.arrays = {{"frequency", {"Hz", {2}, {1.0, 2.0}, {}}}, {"response", {"", {2, 5, 2}, std::vector<double>(20, 1.0), {}}}};
  const auto charts = bode_charts(*read_response(record), nullptr);
  REQUIRE(charts.size() == 4);
  CHECK(charts[0].panels[0].series.size() == 4);
  CHECK(charts[1].panels[0].series.size() == 1);
}
