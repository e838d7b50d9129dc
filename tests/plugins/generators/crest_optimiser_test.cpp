#include "crest_optimiser.hpp"

#include <cmath>
#include <functional>

#include "catch.hpp"
#include "peak_norm.hpp"

using namespace bodeflow::generators;
using bodeflow::numerics::Random;

namespace {

std::vector<Line> lines_where(std::int64_t highest, const std::function<bool(std::int64_t)>& excited) {
  std::vector<Line> lines;
  for (std::int64_t k = 1; k <= highest; ++k) {
    if (excited(k)) lines.push_back({k, 1.0, 0.0});
  }
  const std::vector<double> phases = schroeder_phases(lines);
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i].phase_rad = phases[i];
  return lines;
}

std::vector<Line> optimised(std::vector<Line> lines, std::size_t points) {
  const std::vector<double> phases = optimise_phases(lines, points);
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i].phase_rad = phases[i];
  return lines;
}

// With 32 points a period of the highest line.
double crest_between_samples(const std::vector<Line>& lines) { return crest_factor(synthesise(32 * lines.back().k, lines)); }

}  // namespace

TEST_CASE("the gradient of the p-norm is that of its values") {
  std::vector<Line> lines = lines_where(23, [](std::int64_t k) { return k % 3 != 0; });
  lines[4].amplitude = 0.3;
  PeakNorm norm(lines);
  Random random(5);
  std::vector<double> cycles(lines.size()), gradient(lines.size()), unused(lines.size());
  for (double& phase : cycles) phase = random.uniform();
  for (const int power : {1, 2, 5}) {
    norm.evaluate(cycles, power, gradient);
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      std::vector<double> moved = cycles;
      moved[i] += 1e-6;
      const double above = norm.evaluate(moved, power, unused);
      moved[i] -= 2e-6;
      CHECK(gradient[i] == Approx((above - norm.evaluate(moved, power, unused)) / 2e-6).epsilon(1e-4).margin(1e-8));
    }
  }
}

TEST_CASE("optimised phases have a crest factor below Schroeder's on flat, odd and gappy lines, between the samples as well") {
  struct Case {
    std::vector<Line> lines;
    double highest;
  };
  const Case flat{lines_where(31, [](auto) { return true; }), 1.45};
  const Case odd{lines_where(119, [](auto k) { return k % 2 == 1; }), 1.45};
  const Case gappy{lines_where(199, [](auto k) { return k % 2 == 1 && k % 8 != 3; }), 1.5};
  const Case band{lines_where(160, [](auto k) { return k >= 80; }), 1.6};
  for (const Case& c : {flat, odd, gappy, band}) {
    const double found = crest_between_samples(optimised(c.lines, 500'000));
    CAPTURE(c.lines.size(), crest_between_samples(c.lines), found);
    CHECK(found < c.highest);
    CHECK(found < 0.85 * crest_between_samples(c.lines));
  }
}

TEST_CASE("crest factors of optimised phases with the whole work of a run", "[long]") {
  for (const std::int64_t count : {15, 31, 120, 500}) {
    const double found = crest_between_samples(optimised(lines_where(count, [](auto) { return true; }), kOptimiserPoints));
    CAPTURE(count, found);
    CHECK(found < 1.42);
  }
}

TEST_CASE("optimised phases leave the amplitudes as they are and come out the same twice") {
  std::vector<Line> lines = lines_where(40, [](auto k) { return k % 4 != 2; });
  for (Line& line : lines) line.amplitude = 1 / static_cast<double>(line.k);
  const std::vector<Line> first = optimised(lines, 200000), second = optimised(lines, 200000);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(first[i].phase_rad == second[i].phase_rad);
    CHECK(std::abs(first[i].phase_rad) <= 3.1415926535897936);
  }
  CHECK(crest_between_samples(first) < crest_between_samples(lines));
}

TEST_CASE("one line alone has the crest factor of a cosine, whatever its phase") {
  CHECK(crest_between_samples(optimised({{7, 2.0, 1.0}}, 10000)) == Approx(std::sqrt(2.0)));
}
