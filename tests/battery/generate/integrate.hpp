#pragma once

#include <array>
#include <cstddef>

#include "generate/drive.hpp"

namespace battery {

template <std::size_t N>
using State = std::array<double, N>;

template <std::size_t N>
State<N> moved(const State<N>& x, double step, const State<N>& slope) {
  State<N> result = x;
  for (std::size_t n = 0; n < N; ++n) result[n] += step * slope[n];
  return result;
}

/// One step of the classical Runge-Kutta method of order 4: dx/dt = slope(c, x), where c = 0, 1/2, 1 of the step.
template <std::size_t N, class Slope>
State<N> runge_kutta(const State<N>& x, double step, Slope&& slope) {
  const State<N> a = slope(0.0, x);
  const State<N> b = slope(0.5, moved(x, 0.5 * step, a));
  const State<N> c = slope(0.5, moved(x, 0.5 * step, b));
  const State<N> d = slope(1.0, moved(x, step, c));
  State<N> result = x;
  for (std::size_t n = 0; n < N; ++n) result[n] += step / 6.0 * (a[n] + 2.0 * b[n] + 2.0 * c[n] + d[n]);
  return result;
}

/// How the input goes on between its samples.
enum class Between { held, smooth };

/// The input at c = 0, 1/2, 1 of a substep counted from the beginning of the simulation.
inline double input_at(const Drive& d, Between between, std::size_t substep, double c) {
  const std::size_t n =
      between == Between::held ? (substep / kSubsteps) * 2 * kSubsteps : 2 * substep + static_cast<std::size_t>(2.0 * c);
  return d.half_steps[n % d.half_steps.size()];
}

/// Output at every substep, settling included: dx/dt = slope(t, u, x), t since the record began, y = output(x).
template <std::size_t N, class Slope, class Output>
Series integrate(const Drive& d, Between between, State<N> x, Slope&& slope, Output&& output) {
  const std::size_t steps = d.all_samples() * kSubsteps;
  const double h = d.sample_time / static_cast<double>(kSubsteps);
  Series y(steps);
  for (std::size_t n = 0; n < steps; ++n) {
    y[n] = output(x);
    x = runge_kutta(x, h, [&](double c, const State<N>& s) {
      return slope(d.time(static_cast<double>(n) + c), input_at(d, between, n, c), s);
    });
  }
  return y;
}

}  // namespace battery
