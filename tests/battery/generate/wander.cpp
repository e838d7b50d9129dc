#include <cmath>
#include <numbers>

#include "generate/integrate.hpp"
#include "generate/sensors.hpp"

namespace battery {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// x of the Lorenz system, whose standard deviation is 7.9, with half of its time unit in 1 / rate.
Series lorenz(const Wander& w, const Drive& d, Random& random) {
  State<3> x{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(20.0, 30.0)};
  const double step = 0.5 * w.rate_hz * d.sample_time;
  const auto slope = [](double, const State<3>& s) {
    return State<3>{10.0 * (s[1] - s[0]), s[0] * (28.0 - s[2]) - s[1], s[0] * s[1] - 8.0 / 3.0 * s[2]};
  };
  Series values(d.all_samples());
  for (double& v : values) {
    v = x[0] / 7.9;
    x = runge_kutta(x, step, slope);
  }
  return values;
}

}  // namespace

Wander draw_wander(const Plant& plant, Random& random) {
  const double period_s = static_cast<double>(kPeriodSamples) * plant.sample_time();
  const auto kind = static_cast<Wander::Kind>(random.below(3));
  return {kind, (static_cast<double>(random.below(6)) + random.uniform(0.25, 0.75)) / period_s};
}

Series wander_signal(const Wander& w, const Drive& d, Random& random) {
  if (w.kind == Wander::chaotic) return lorenz(w, d, random);
  Series values(d.all_samples());
  const double keep = std::exp(-kTwoPi * w.rate_hz * d.sample_time), phase = random.uniform(0.0, kTwoPi);
  double x = random.normal();
  for (std::size_t n = 0; n < values.size(); ++n) {
    values[n] = w.kind == Wander::sine
                    ? std::sqrt(2.0) * std::sin(kTwoPi * w.rate_hz * d.sample_time * static_cast<double>(n) + phase)
                    : x;
    x = keep * x + std::sqrt(1.0 - keep * keep) * random.normal();
  }
  return values;
}

}  // namespace battery
