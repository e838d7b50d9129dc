#pragma once

#include "loop.hpp"

namespace bodeflow::test {

/// A plant of the battery with what an operator would know of it, and what happens to it. It meets the declared specification
/// where the known plant's design of second order meets its demands with margins: controller poles within 0.7, residual 0.2,
/// sensitivity 1.8.
struct Case {
  Example example;
  bool meets_specification = false;
  std::string kind;
  double noise = 0.0, load = 0.0, limit = 0.0, change = 1.0;
};

/// What became of it.
struct Outcome {
  bool finite = true, adapted = false;
  double largest_output = 0.0;
  double saturated_share = 0.0;           ///< of the last 500 samples, without a change of the command
  double error = 0.0, known_error = 0.0;  ///< rms of y - y_m from 300 to 1000: adaptive, and with the known plant
  std::int64_t silent_events = 0;         ///< designs on the ladder or kept without a log entry
};

namespace battery {

using numerics::Random;

inline double between(Random& r, double low, double high) { return low + (high - low) * r.uniform(); }

/// A plant of order 1 to 6 whose slowest dynamics suit h = 1: poles around 1, then scaled in time.
inline numerics::TransferFunction plant(Random& r, std::string& kind) {
  const int order = 1 + static_cast<int>(6.0 * r.uniform());
  Eigen::VectorXd denominator = poly({1.0}), numerator = poly({1.0});
  int left = order;
  const double draw = r.uniform();
  kind = "stable";
  if (draw < 0.15 && order >= 2) {
    kind = "integrating";
    denominator = poly({1.0, 0.0});
    --left;
  } else if (draw < 0.3 && order >= 2) {
    kind = "lightly damped";
    const double w = between(r, 0.8, 1.6), damping = between(r, 0.15, 0.4);
    denominator = poly({1.0, 2.0 * damping * w, w * w});
    left -= 2;
  } else if (draw < 0.5 && order >= 2) {
    kind = "non-minimum phase";
    numerator = poly({-between(r, 0.3, 2.0), 1.0});
  }
  for (; left > 0; --left) {
    const double pole = between(r, 0.7, 2.0);
    denominator = numerics::multiply(denominator, poly({1.0, pole}));
  }
  const double gain = std::exp(between(r, -1.5, 1.5));
  numerator *= gain;
  return {numerator, denominator, 0.0};
}

inline numerics::TransferFunction slower(const numerics::TransferFunction& g, double factor) {
  numerics::TransferFunction scaled = g;  // s -> s / factor
  scaled.denominator = ac::faster(g.denominator, factor);
  scaled.numerator = ac::faster(g.numerator, factor);
  const double lost = std::pow(factor, static_cast<double>(g.denominator.size() - g.numerator.size()));
  scaled.numerator *= lost;
  return scaled;
}

/// The first frequency of a phase of -180 degrees, 3 where there is none below it.
inline double crossover(const numerics::TransferFunction& g, double delay) {
  std::vector<double> omega;
  for (int i = 1; i <= 600; ++i) omega.push_back(3.0 * i / 600.0);
  const auto response = *ac::sampled_response(g, delay, 1.0, omega);
  double phase = std::arg(response[0]), before = phase;
  for (std::size_t i = 1; i < omega.size(); ++i) {
    const double now = std::arg(response[i]);
    phase += std::remainder(now - before, 2.0 * std::numbers::pi);
    before = now;
    if (phase < -std::numbers::pi) return omega[i];
  }
  return 3.0;
}

/// What a look at the step response tells: samples below 1 % of its size after 10 / omega samples, and the delay d for the
/// estimators, one less where the first response is large at once, as that of a plant of low order is.
struct DelayLook {
  int zeros = 0, d = 0;
};
inline constexpr double kNearlyZero = 0.01;
inline DelayLook delay_look(const numerics::TransferFunction& g, double delay, double omega) {
  SimulatedPlant simulated(g, delay);
  std::vector<double> y;
  for (int k = 0; k < static_cast<int>(10.0 / omega) + 20; ++k) {
    y.push_back(simulated.output());
    simulated.input(1.0);
  }
  DelayLook look;
  while (look.zeros < 30 && y[static_cast<std::size_t>(look.zeros)] < kNearlyZero * y.back()) ++look.zeros;
  look.d = look.zeros - (y[static_cast<std::size_t>(look.zeros)] > 0.1 * y.back() && look.zeros > 0 ? 1 : 0);
  return look;
}

/// The fastest demands, in steps of 7 %, that the known plant's design meets with margins; 0 where there are none.
inline double demands_with_margin(ac::DesignerSettings s, const std::vector<std::complex<double>>& response, double fastest,
                                  double w_m) {
  s.desired = ac::scaled(s.desired, fastest / w_m);
  s.ladder_steps = 40;
  s.ladder_ratio = 0.93;
  s.limits = {0.7, 0.2, 1.8};
  auto designer = ac::Designer::make(s);
  designer->step(response.data());
  return designer->level() < 0 ? 0.0 : fastest * std::pow(0.93, designer->level());
}

}  // namespace battery

inline constexpr double kLargestOutput = 20.0;  // the command is +-1

/// The case of a seed: plant, demands after section 7.4, disturbances.
inline Case battery_case(std::uint64_t seed) {
  using namespace battery;
  numerics::Random r(seed);
  Case c;
  numerics::TransferFunction g = plant(r, c.kind);
  const double delay = std::floor(6.0 * r.uniform());
  // So slow that a phase of -180 degrees lies at 0.25 to 0.7 rad a sample, as far as the delay allows.
  const double wanted = between(r, 0.25, 0.7);
  double factor = 1.0;
  for (int i = 0; i < 40; ++i) factor *= crossover(slower(g, factor), delay) > wanted ? 0.9 : 1.0;
  g = slower(g, factor);
  const double omega = std::min(crossover(g, delay), 2.0);
  const auto order = static_cast<int>(g.denominator.size()) - 1;
  const DelayLook look = delay_look(g, delay, omega);
  const double gain = std::abs((*ac::sampled_response(g, delay, 1.0, {omega}))[0]);
  double w_m = omega;
  const double highest = omega, lowest = std::max(0.06, omega / 6.3);
  std::vector<double> points;
  for (int j = 0; j < 4; ++j) points.push_back(lowest * std::pow(highest / lowest, j / 3.0));
  const Eigen::VectorXd a_m = ac::dominant_poles(std::clamp(order, 2, 5), w_m, 3.0);
  c.example = example(g, delay, points, look.d, 2, a_m, std::max(0, look.zeros - 1), ac::bessel(2, 0.8 * w_m), 0.35 / gain);
  Example& e = c.example;
  const double met = demands_with_margin(e.design, true_response(e), 2.5 * omega, w_m);
  if (met > 0.0) {
    e.design.desired = ac::scaled(e.design.desired, 0.9 * met / w_m);
    w_m = 0.9 * met;
  }
  auto nominal = ac::Designer::make(e.design);
  nominal->step(true_response(e).data());
  c.meets_specification = met > 0.0 && nominal->level() == 0;
  e.design.start = 120;
  e.clock = std::clamp(static_cast<int>(12.0 / w_m), 20, 60);
  e.bank.point.forgetting = 0.99;
  e.bank.point.p0 = 1e4;
  e.bank.point.warm_up = 60;
  e.bank.input_scale = 0.35 / gain;
  c.noise = between(r, 0.0, 0.02);
  c.load = between(r, -0.2, 0.2) / gain * (c.kind == "integrating" ? 0.1 : 1.0);
  c.limit = 6.0 / gain;
  c.change = between(r, 0.7, 1.4);
  return c;
}

inline Outcome outcome_of(const Case& c, std::uint64_t seed) {
  Conditions conditions;
  conditions.samples = 3000;
  conditions.noise = c.noise;
  conditions.seed = seed;
  conditions.limit = c.limit;
  conditions.load_at = 1000;
  conditions.load = c.load;
  conditions.gain = [&](int k) { return k < 1500 ? 1.0 : c.change; };
  Command command(c.example.clock);
  double value = 0.0;
  conditions.command = [&](int k) { return value = k < 2000 ? command.next() : value; };
  const Run adaptive = run(c.example, conditions);
  Outcome o;
  o.adapted = adaptive.adapted;
  for (std::size_t k = 0; k < adaptive.y.size(); ++k) {
    o.finite &= std::isfinite(adaptive.y[k]);
    o.largest_output = std::max(o.largest_output, std::abs(adaptive.y[k]));
    if (k >= 2500) o.saturated_share += (std::abs(adaptive.u[k]) >= c.limit ? 1.0 : 0.0) / 500.0;
  }
  o.error = adaptive.rms(300, 1000);
  Command again(c.example.clock);
  conditions.command = [&](int k) { return value = k < 2000 ? again.next() : value; };
  conditions.known_plant = true;
  o.known_error = run(c.example, conditions).rms(300, 1000);
  return o;
}

}  // namespace bodeflow::test
