#include "acquisition/resampler.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <functional>

#include "catch.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;

namespace {

ResamplerPlan plan_of(const ResamplerSpec& spec) {
  const auto plan = plan_resampler(spec);
  REQUIRE(plan);
  return *plan;
}

/// The outputs for x[n] = signal(n), in calls of `step` firings.
std::vector<double> resample(const ResamplerPlan& plan, const std::function<double(double)>& signal, std::int64_t firings,
                             std::int64_t step = 64) {
  Resampler r(plan, 1, step);
  std::vector<double> all, x, y;
  for (std::int64_t first = 0; first < firings; first += step) {
    const std::int64_t count = std::min(step, firings - first);
    x.clear();
    for (std::int64_t n = first * plan.spec.down; n < (first + count) * plan.spec.down; ++n)
      x.push_back(signal(static_cast<double>(n)));
    y.assign(static_cast<std::size_t>(count * plan.spec.up), 0.0);
    REQUIRE(r.run(0, first, x, y));
    all.insert(all.end(), y.begin(), y.end());
  }
  return all;
}

/// The largest difference to `expected(m)`, past the start.
double error_of(const ResamplerPlan& plan, const std::vector<double>& y, const std::function<double(double)>& expected) {
  double most = 0.0;
  const auto start = static_cast<std::size_t>(plan.delay + 2 * plan.reach * plan.spec.up / plan.spec.down + 2);
  REQUIRE(start + 100 < y.size());
  for (std::size_t m = start; m < y.size(); ++m)
    most = std::max(most, std::abs(y[m] - expected(static_cast<double>(static_cast<std::int64_t>(m) - plan.delay))));
  return most;
}

constexpr double kTurn = 2 * M_PI;

}  // namespace

TEST_CASE("resampler: sines of the pass band come out delayed by whole samples, within the stated ripple") {
  for (const auto& [up, down] : {std::pair<std::int64_t, std::int64_t>{160, 147}, {147, 160}, {1, 3}, {3, 1}, {2, 3}}) {
    for (const double attenuation : {60.0, 100.0}) {
      ResamplerSpec spec{up, down};
      spec.attenuation_db = attenuation;
      const auto plan = plan_of(spec);
      const double ratio = static_cast<double>(down) / static_cast<double>(up);
      for (const double part : {0.0, 0.1, 0.5, 0.8}) {
        const double f = part * 0.5 * std::min(1.0, 1.0 / ratio);  // of the input rate
        INFO(up << "/" << down << ", " << attenuation << " dB, " << part);
        const auto y = resample(
            plan, [&](double n) { return std::cos(kTurn * f * n + 0.3); }, 2000 / std::min(up, down) + 200);
        const double ripple = error_of(plan, y, [&](double m) { return std::cos(kTurn * f * m * ratio + 0.3); });
        CHECK(ripple <= 2 * std::pow(10.0, -attenuation / 20));
      }
    }
  }
}

TEST_CASE("resampler: what lies above the lower Nyquist frequency is stopped") {
  const ResamplerSpec spec{147, 160};
  const auto plan = plan_of(spec);
  for (const double part : {1.0, 1.03, 1.08}) {
    const double f = part * 0.5 * 147 / 160;
    INFO(part);
    const auto y = resample(
        plan, [&](double n) { return std::cos(kTurn * f * n + 0.3); }, 20);
    CHECK(error_of(plan, y, [](double) { return 0.0; }) <= 1e-5);
  }
}

TEST_CASE("resampler: a known drift of the input clock is corrected, fast and slow, over the whole stream") {
  for (const double drift : {50e-6, -50e-6, 2e-3, -2e-3}) {
    for (const auto& [up, down] : {std::pair<std::int64_t, std::int64_t>{1, 1}, {160, 147}, {1, 4}}) {
      ResamplerSpec spec{up, down, drift};
      const std::int64_t firings = 60000 / down;
      spec.buffer = static_cast<std::int64_t>(std::ceil(std::abs(drift) * static_cast<double>(firings * down))) + 1;
      const auto plan = plan_of(spec);
      const double ratio = static_cast<double>(down) / static_cast<double>(up);
      const double f = 0.8 * 0.5 * std::min(1.0, 1.0 / ratio) * 0.97;  // by the output's clock, of the stated input rate
      INFO(drift << ", " << up << "/" << down);
      // Sample n of a device that runs fast is taken early.
      const auto y = resample(
          plan, [&](double n) { return std::cos(kTurn * f * n / (1 + drift) + 0.3); }, firings, 500);
      CHECK(error_of(plan, y, [&](double m) { return std::cos(kTurn * f * m * ratio + 0.3); }) <= 2e-5);
    }
  }
}

TEST_CASE("resampler: the buffer ends where drift has used it up, at the same sample in calls of any size") {
  ResamplerSpec spec{1, 1, 1e-3};
  spec.buffer = 3;
  const auto plan = plan_of(spec);
  for (const std::int64_t step : {1, 7, 500}) {
    Resampler r(plan, 1, step);
    const std::vector<double> x(static_cast<std::size_t>(step), 1.0);
    std::vector<double> y(x.size());
    std::int64_t good = 0;
    for (std::int64_t first = 0;; first += step) {
      const bool whole = r.run(0, first, x, y);
      for (const double v : y) good += v > 0.5 ? 1 : 0;
      if (!whole) break;
      REQUIRE(first < 10000);
    }
    INFO(step);
    CHECK(good == 3001);  // 0.001 x 3000 samples and the one at zero, less and more half a filter
  }
}

TEST_CASE("resampler: the same bits in calls of any size, and after a reset") {
  for (const double drift : {0.0, 1e-4, -1e-4}) {
    ResamplerSpec spec{3, 2, drift};
    spec.buffer = 2;
    const auto plan = plan_of(spec);
    const auto noise = [](double n) { return numerics::Random(static_cast<std::uint64_t>(n) + 1).normal(); };
    const auto whole = resample(plan, noise, 1000, 1000);
    for (const std::int64_t step : {1, 7, 333}) CHECK(resample(plan, noise, 1000, step) == whole);
    Resampler r(plan, 1, 1000);
    std::vector<double> x(2000, 5.0), y(3000);
    REQUIRE(r.run(0, 0, x, y));
    r.reset();
    for (std::size_t n = 0; n < x.size(); ++n) x[n] = noise(static_cast<double>(n));
    REQUIRE(r.run(0, 0, x, y));
    CHECK(y == whole);
  }
}

TEST_CASE("resampler: equal rates without drift are a wire, and rates in no simple ratio are refused") {
  const auto wire = plan_of({1, 1});
  CHECK(wire.is_wire());
  CHECK(wire.delay == 0);
  CHECK(resample(
            wire, [](double n) { return n; }, 5) == std::vector<double>{0, 1, 2, 3, 4});
  CHECK(
      plan_resampler({48001, 44100}).error().text ==
      "the output rate is 48001/44100 of the input rate; numbers up to 16384 are possible: choose a rate in a simpler ratio, and "
      "`drift` for small deviations");
}
