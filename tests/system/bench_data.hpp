#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace bodeflow::test {

/// Samples of a plant y[n] = 1.5 y[n-1] - 0.7 y[n-2] + 0.4 u[n-1] + 0.2 u[n-2] at 100 Hz, white noise on both signals.
struct BenchData {
  std::size_t samples = 3000;
  unsigned seed = 1;
  double noise = 0.1;      ///< standard deviation of it
  double amplitude = 1.0;  ///< standard deviation of the input
  std::size_t period = 0;  ///< samples after which the input repeats; 0: never
};

inline std::string csv_of(const std::vector<std::string>& heads, const std::vector<std::vector<double>>& columns) {
  std::string text;
  for (const auto& head : heads) text += (text.empty() ? "" : ",") + head;
  text += '\n';
  char number[32];
  for (std::size_t n = 0; n < columns.front().size(); ++n) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::snprintf(number, sizeof number, "%s%.17g", c == 0 ? "" : ",", columns[c][n]);
      text += number;
    }
    text += '\n';
  }
  return text;
}

/// Columns t [s], voltage [V], current [A].
inline std::string bench_csv(const BenchData& d = {}) {
  std::mt19937 bits(d.seed);
  std::normal_distribution<double> normal;
  std::vector<double> t, u, y, u_noisy, y_noisy;
  for (std::size_t n = 0; n < d.samples; ++n) {
    t.push_back(static_cast<double>(n) / 100.0);
    u.push_back(d.period > 0 && n >= d.period ? u[n - d.period] : d.amplitude * normal(bits));
    double now = 0.0;
    if (n >= 1) now += 1.5 * y[n - 1] + 0.4 * u[n - 1];
    if (n >= 2) now += -0.7 * y[n - 2] + 0.2 * u[n - 2];
    y.push_back(now);
  }
  for (std::size_t n = 0; n < d.samples; ++n) {
    u_noisy.push_back(u[n] + d.noise * normal(bits));
    y_noisy.push_back(y[n] + d.noise * normal(bits));
  }
  return csv_of({"t [s]", "voltage [V]", "current [A]"}, {t, u_noisy, y_noisy});
}

}  // namespace bodeflow::test
