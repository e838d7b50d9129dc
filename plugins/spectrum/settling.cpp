#include "settling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sine_window.hpp"

namespace bodeflow::spectrum {

Correlation sliding_correlation(std::span<const double> y, std::int64_t window, std::int64_t cycles) {
  Correlation c;
  const auto length = static_cast<std::size_t>(window);
  if (y.size() < length) return c;
  c.a.reserve(y.size() - length + 1);
  c.b.reserve(y.size() - length + 1);
  const SineTable table(window, cycles);
  SineWindow sum(window);
  std::size_t at = 0;
  for (std::size_t n = 0; n < y.size(); ++n) {
    const std::complex<double> value = sum.push(y[n] * table[at]);
    at = at + 1 == length ? 0 : at + 1;
    if (n + 1 < length) continue;
    c.a.push_back(value.real());
    c.b.push_back(-value.imag());
  }
  return c;
}

std::vector<double> envelope(std::span<const double> a) {
  std::vector<double> delta(a.size());
  if (a.empty()) return delta;
  double largest = a.back(), smallest = a.back();
  for (std::size_t p = a.size(); p-- > 0;) {
    largest = std::max(largest, a[p]);
    smallest = std::min(smallest, a[p]);
    delta[p] = largest - smallest;
  }
  return delta;
}

std::size_t settled_from(const Correlation& correlation, double threshold) {
  SettledStretch a(threshold), b(threshold);
  for (const double value : correlation.a) a.push(value);
  for (const double value : correlation.b) b.push(value);
  return std::max(a.from(), b.from());
}

double settling_threshold(double sigma, std::int64_t window, double factor) {
  return factor * sigma * std::sqrt(2.0 / static_cast<double>(window));
}

double mean_from(std::span<const double> v, std::size_t from) {
  const auto rest = v.subspan(from);
  return std::accumulate(rest.begin(), rest.end(), 0.0) / static_cast<double>(rest.size());
}

void SettledStretch::push(double value) {
  while (!falling_.empty() && falling_.back().value <= value) falling_.pop_back();
  while (!rising_.empty() && rising_.back().value >= value) rising_.pop_back();
  falling_.push_back({pushed_, value});
  rising_.push_back({pushed_, value});
  ++pushed_;
  while (falling_.front().value - rising_.front().value > range_) {
    from_ = std::min(falling_.front().at, rising_.front().at) + 1;
    if (falling_.front().at < from_) falling_.pop_front();
    if (rising_.front().at < from_) rising_.pop_front();
  }
}

}  // namespace bodeflow::spectrum
