#include "report/curve.hpp"

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "report/numbers.hpp"

using namespace bodeflow::tools::report;

namespace {

Axis exact_axis(double high) { return make_axis(Scale::exact, 0.0, high, 5, ""); }

Series noise(std::size_t count) {
  Series series;
  for (std::size_t n = 0; n < count; ++n) {
    series.x.push_back(static_cast<double>(n));
    series.y.push_back(std::sin(0.7 * static_cast<double>(n)));
  }
  return series;
}

std::size_t points_in(const std::string& svg) {
  return static_cast<std::size_t>(std::count(svg.begin(), svg.end(), 'L') + std::count(svg.begin(), svg.end(), 'M'));
}

}  // namespace

TEST_CASE("report curve: a million points become a few thousand, and no extreme is lost") {
  Series series = noise(1'000'000);
  series.y[123'456] = 40.0;
  series.y[765'432] = -40.0;
  const auto kept = telling_points(series, exact_axis(1e6), 500);
  CHECK(kept.size() <= 2004);
  CHECK(std::is_sorted(kept.begin(), kept.end()));
  CHECK(std::count(kept.begin(), kept.end(), 123'456U) == 1);
  CHECK(std::count(kept.begin(), kept.end(), 765'432U) == 1);
  CHECK(kept.front() == 0);
  CHECK(kept.back() == 999'999);
}

TEST_CASE("report curve: the extremes of a band are kept too") {
  Series series = noise(100'000);
  for (const double y : series.y) {
    series.low.push_back(y - 1.0);
    series.high.push_back(y + 1.0);
  }
  series.high[50'001] = 9.0;
  series.low[70'001] = -9.0;
  const auto kept = telling_points(series, exact_axis(1e5), 300);
  CHECK(std::count(kept.begin(), kept.end(), 50'001U) == 1);
  CHECK(std::count(kept.begin(), kept.end(), 70'001U) == 1);
}

TEST_CASE("report curve: short curves stay whole, in order of x, without lines that have no place") {
  Series series;
  series.x = {3.0, 0.0, 1.0, kNaN, 2.0};
  series.y = {1.0, 1.0, 1.0, 1.0, 1.0};
  const Axis axis = make_axis(Scale::logarithmic, 1.0, 10.0, 4, "");
  CHECK(telling_points(series, axis, 100) == std::vector<std::size_t>{2, 4, 0});
}

TEST_CASE("report curve: missing values are gaps, a point alone is a marker, and nothing but finite numbers is drawn") {
  const Axis x = exact_axis(6.0), y = make_axis(Scale::linear, -1.0, 1.0, 4, "");
  const Frame frame{0.0, 0.0, 100.0, 100.0, &x, &y};
  Series series;
  series.x = {0, 1, 2, 3, 4, 5, 6};
  series.y = {0, 0.5, kNaN, 0.2, kNaN, 0.1, INFINITY};
  series.low = {-HUGE_VAL, 0.4, kNaN, 0.1, kNaN, -HUGE_VAL, 0.0};
  series.high = {0.2, 0.6, kNaN, 0.3, kNaN, HUGE_VAL, 0.1};
  Markup body;
  draw_series(body, frame, series);
  CHECK(body.str().find("nan") == std::string::npos);
  CHECK(body.str().find("inf") == std::string::npos);
  CHECK(body.str().find("<circle") != std::string::npos);
}

TEST_CASE("report curve: a long curve draws at most four points for two units of width") {
  const Axis x = exact_axis(1e5), y = make_axis(Scale::linear, -1.0, 1.0, 4, "");
  const Frame frame{0.0, 0.0, 800.0, 200.0, &x, &y};
  Markup body;
  draw_series(body, frame, noise(100'000));
  CHECK(points_in(body.str()) <= 1700);
  CHECK(points_in(body.str()) > 800);
}
