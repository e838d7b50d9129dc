#include "report/axis.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "catch.hpp"

using namespace bodeflow::tools::report;

namespace {

std::vector<std::string> labels_of(const Axis& axis) {
  std::vector<std::string> labels;
  for (const auto& tick : axis.ticks) labels.push_back(tick.label);
  return labels;
}

}  // namespace

TEST_CASE("report axis: decades are labelled, 2 to 9 between them are thin lines") {
  const Axis axis = make_axis(Scale::logarithmic, 1.0, 1000.0, 4, "");
  CHECK(labels_of(axis) == std::vector<std::string>{"1", "10", "100", "1000"});
  CHECK(axis.minor.size() == 24);
  CHECK(axis.place(1.0) == Approx(0.0).margin(1e-12));
  CHECK(axis.place(1000.0) == Approx(1.0));
  CHECK_FALSE(std::isfinite(axis.place(0.0)));
}

TEST_CASE("report axis: less than a decade is labelled at round numbers") {
  CHECK(labels_of(make_axis(Scale::logarithmic, 5.0, 200.0, 12, "")) ==
        std::vector<std::string>{"5", "10", "20", "50", "100", "200"});
  CHECK(make_axis(Scale::logarithmic, 41.0, 48.0, 6, "").ticks.size() >= 2);
}

TEST_CASE("report axis: decibels step by 10 or 20, degrees by parts of a turn, and the ends are ticks") {
  const Axis decibel = make_axis(Scale::decibel, -57.0, 3.0, 6, "");
  CHECK(labels_of(decibel) == std::vector<std::string>{"−60", "−50", "−40", "−30", "−20", "−10", "0", "10"});
  const Axis degrees = make_axis(Scale::degrees, -200.0, 100.0, 4, "");
  CHECK(labels_of(degrees) == std::vector<std::string>{"−270", "−180", "−90", "0", "90", "180"});
}

TEST_CASE("report axis: labels that stand beside each other differ") {
  for (const auto& [low, high] : {std::pair{1.0, 1.0001}, {1e-9, 3e-9}, {123456.0, 123457.0}, {-1e12, 1e12}, {0.0, 0.0}}) {
    const Axis axis = make_axis(Scale::linear, low, high, 5, "");
    const auto labels = labels_of(axis);
    INFO(low << " to " << high);
    CHECK(labels.size() >= 2);
    CHECK(std::set<std::string>(labels.begin(), labels.end()).size() == labels.size());
    CHECK(axis.low < axis.high);
  }
}

TEST_CASE("report axis: extreme values give a finite axis with few ticks") {
  const double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
  for (const Scale scale : {Scale::exact, Scale::linear, Scale::decibel, Scale::degrees, Scale::logarithmic})
    for (const auto& [low, high] : {std::pair{tiny, huge}, {huge, huge}, {tiny, tiny}, {1.0, huge}}) {
      const Axis axis = make_axis(scale, low, high, 6, "");
      INFO(static_cast<int>(scale) << " from " << low << " to " << high);
      CHECK(std::isfinite(axis.low));
      CHECK(axis.low < axis.high);
      CHECK(axis.ticks.size() <= 210);
      for (const auto& tick : axis.ticks) CHECK(std::isfinite(axis.place(tick.value)));
    }
}
