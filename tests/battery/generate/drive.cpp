#include "generate/drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace battery {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kFresh = 64;  // steps after which the rotating phasor is computed anew, so that errors don't add up

}  // namespace

double Drive::omega(std::size_t j) const { return kTwoPi * lines[j] / (static_cast<double>(period) * sample_time); }

Drive make_drive(const std::vector<int>& lines, std::size_t period, double sample_time, double rms, double level,
                 Random& random) {
  Drive d;
  d.period = period;
  d.sample_time = sample_time;
  d.level = level;
  d.lines = lines;
  d.amplitude = level * rms * std::sqrt(2.0 / static_cast<double>(lines.size()));
  const std::size_t steps = period * 2 * kSubsteps;
  d.half_steps.assign(steps, 0.0);
  for (const int line : lines) {
    d.phases.push_back(random.uniform(0.0, kTwoPi));
    const double angle = kTwoPi * line / static_cast<double>(steps);
    const Complex turn = std::polar(1.0, angle);
    Complex value;
    for (std::size_t n = 0; n < steps; ++n) {
      value = n % kFresh == 0 ? std::polar(d.amplitude, angle * static_cast<double>(n) + d.phases.back()) : value * turn;
      d.half_steps[n] += value.real();
    }
  }
  return d;
}

std::vector<int> leave_some_out(const std::vector<int>& lines, Random& random) {
  std::vector<int> kept;
  for (std::size_t first = 0; first < lines.size(); first += 4) {
    const std::size_t empty = first + random.below(4);
    for (std::size_t n = first; n < std::min(first + 4, lines.size()); ++n) {
      if (n != empty) kept.push_back(lines[n]);
    }
  }
  return kept;
}

std::vector<Complex> coefficients(const Series& one_period, const std::vector<int>& lines) {
  const double count = static_cast<double>(one_period.size());
  std::vector<Complex> result;
  for (const int line : lines) {
    const Complex turn = std::polar(1.0, -kTwoPi * line / count);
    Complex sum, value;
    for (std::size_t n = 0; n < one_period.size(); ++n) {
      value = n % kFresh == 0 ? std::polar(1.0, -kTwoPi * line * static_cast<double>(n) / count) : value * turn;
      sum += one_period[n] * value;
    }
    result.push_back(sum * (2.0 / count));
  }
  return result;
}

Series from_coefficients(const Drive& d, const std::vector<Complex>& c) {
  Series y(d.samples(), 0.0);
  for (std::size_t j = 0; j < c.size(); ++j) {
    const auto line = static_cast<std::size_t>(d.lines[j]);
    for (std::size_t n = 0; n < d.period; ++n) {
      y[n] +=
          (c[j] * std::polar(1.0, kTwoPi * static_cast<double>((line * n) % d.period) / static_cast<double>(d.period))).real();
    }
  }
  for (std::size_t n = d.period; n < y.size(); ++n) y[n] = y[n - d.period];
  return y;
}

Series sampled(const Drive& d, const Series& fine) {
  Series y(d.samples());
  for (std::size_t n = 0; n < y.size(); ++n) y[n] = fine[(n + kSettling * d.period) * kSubsteps];
  return y;
}

double mean_square(const Series& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum / static_cast<double>(values.size());
}

double root_mean_square(const Series& values) { return std::sqrt(mean_square(values)); }

double peak(const Series& values) {
  double top = 0.0;
  for (const double v : values) top = std::max(top, std::abs(v));
  return top;
}

}  // namespace battery
