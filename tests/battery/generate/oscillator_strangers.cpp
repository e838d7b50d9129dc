#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/integrate.hpp"
#include "generate/sensors.hpp"

namespace battery {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Samples of an oscillator whose stiffness is multiplied by 1 + softer(t).
template <class Change>
Series with_stiffness(const Oscillator& o, const Drive& d, Change change) {
  const auto slope = [&](double t, double f, const State<2>& x) {
    return State<2>{x[1], (f - o.damping * x[1] - o.stiffness * (1.0 + change(t)) * x[0]) / o.mass};
  };
  return sampled(d, integrate<2>(d, Between::smooth, {}, slope, [](const State<2>& x) { return x[0]; }));
}

/// Rubber that softens while it is worked and recovers.
Hidden softening_spring(const Oscillator& o, const Scale& scale, Random& random) {
  const double recovery = random.log_uniform(0.3, 4.0);
  Hidden h{"softening_spring", 0.02, 0.4, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double, double f, const State<3>& x) {
      const double worked = (x[0] / scale.output_rms) * (x[0] / scale.output_rms),
                   k = o.stiffness * (1.0 - strength * x[2] / (1.0 + x[2]));
      return State<3>{x[1], (f - o.damping * x[1] - k * x[0]) / o.mass, (worked - x[2]) / recovery};
    };
    return sampled(d, integrate<3>(d, Between::smooth, {}, slope, [](const State<3>& x) { return x[0]; }));
  };
  return h;
}

/// A stiffness modulated at a frequency that is foreign to the excitation.
Hidden parametric_stiffness(const Oscillator& o, const Scale&, Random& random) {
  const double period_s = static_cast<double>(kPeriodSamples) * o.sample_time();
  const double f = (static_cast<double>(3 + random.below(40)) + random.uniform(0.25, 0.75)) / period_s;
  Hidden h{"parametric_stiffness", 0.01, 0.1, {}};
  h.run = [=](const Drive& d, double strength, Random& r) {
    const double phase = r.uniform(0.0, kTwoPi);
    return with_stiffness(o, d, [=](double t) { return strength * std::sin(kTwoPi * f * t + phase); });
  };
  return h;
}

/// A stiffness that walks at random through each record.
Hidden wandering_stiffness(const Oscillator& o, const Scale&, Random&) {
  Hidden h{"wandering_stiffness", 0.02, 0.3, {}};
  h.run = [=](const Drive& d, double strength, Random& r) {
    Series walk(d.all_samples() + 2, 0.0);
    const double step = 1.0 / std::sqrt(static_cast<double>(d.samples()));
    for (std::size_t n = kSettling * d.period + 1; n < walk.size(); ++n) walk[n] = walk[n - 1] + step * r.normal();
    return with_stiffness(o, d, [&](double t) {
      const double at = t / d.sample_time + static_cast<double>(kSettling * d.period), whole = std::floor(at);
      const auto n = static_cast<std::size_t>(whole);
      return strength * (walk[n] + (at - whole) * (walk[n + 1] - walk[n]));
    });
  };
  return h;
}

/// A viscous fluid that remembers (A. B. Basset 1888): a force proportional to the half derivative of the velocity, s^1.5 x.
Hidden fluid_memory(const Oscillator& o, const Scale&, Random&) {
  Hidden h{"fluid_memory", 0.05, 3.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const double resonance = std::sqrt(o.stiffness / o.mass);
    std::vector<Complex> c;
    for (std::size_t j = 0; j < d.lines.size(); ++j) {
      const Complex s(0.0, d.omega(j)), memory = strength * o.stiffness * std::pow(s / resonance, 1.5);
      c.push_back(d.line(j) / (o.mass * s * s + o.damping * s + o.stiffness + memory));
    }
    return from_coefficients(d, c);
  };
  return h;
}

/// A scale or gear whose error repeats over the position.
Hidden transmission_error(const Oscillator& o, const Scale& scale, Random& random) {
  const double pitch = scale.output_rms * random.uniform(0.3, 1.2), phase = random.uniform(0.0, kTwoPi);
  Hidden h{"transmission_error", 0.01, 0.2, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Series y = sampled(d, o.clean(d));
    for (double& x : y) x += strength * scale.output_rms * (std::sin(kTwoPi * x / pitch + phase) - std::sin(phase));
    return y;
  };
  return h;
}

}  // namespace

const std::vector<Maker<Oscillator>>& oscillator_strangers() {
  static const std::vector<Maker<Oscillator>> all = {
      {"softening_spring", softening_spring},         {"parametric_stiffness", parametric_stiffness},
      {"wandering_stiffness", wandering_stiffness},   {"fluid_memory", fluid_memory},
      {"transmission_error", transmission_error},     {"gain_wobble", of<Oscillator, gain_wobble>},
      {"clock_wander", of<Oscillator, clock_wander>}, {"level_delay", of<Oscillator, level_delay>},
      {"attack_decay", of<Oscillator, attack_decay>}, {"squared_crosstalk", of<Oscillator, squared_crosstalk>},
  };
  return all;
}

}  // namespace battery
