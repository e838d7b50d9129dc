#pragma once

#include <bodeflow/abi.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>

namespace bodeflow {

/// An exact fraction: a sample rate in hertz, or a time in seconds. num = 0, den = 1: zero or unknown.
struct Rate {
  std::int64_t num = 0;
  std::int64_t den = 1;

  Rate() = default;
  /// Reduced to lowest terms; den > 0.
  Rate(std::int64_t n, std::int64_t d) : num(n), den(d) {
    const std::int64_t g = std::gcd(num, den);
    if (g > 1) {
      num /= g;
      den /= g;
    }
  }
  explicit Rate(const bf_rate& r) : Rate(r.num, r.den == 0 ? 1 : r.den) {}

  /// The simplest fraction within 1e-12 of `value`, relative (continued fraction), denominator up to 1e9; zero for
  /// values that are not positive and finite or beyond 1e15.
  static Rate from_hz(double value) {
    if (!(value > 0.0) || !(value < 1e15)) return {};
    std::int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    double x = value;
    for (int i = 0; i < 64; ++i) {
      const double floor = std::floor(x);
      if (floor > 9e15) break;
      const auto a = static_cast<std::int64_t>(floor);
      const auto p2 = static_cast<long double>(a) * static_cast<long double>(p1) + static_cast<long double>(p0);
      const auto q2 = static_cast<long double>(a) * static_cast<long double>(q1) + static_cast<long double>(q0);
      if (q2 > 1e9L || p2 > 9e17L) break;
      p0 = p1;
      q0 = q1;
      p1 = static_cast<std::int64_t>(p2);
      q1 = static_cast<std::int64_t>(q2);
      if (std::abs(static_cast<double>(p1) / static_cast<double>(q1) - value) <= 1e-12 * value) break;
      const double rest = x - floor;
      if (rest <= 0.0) break;
      x = 1.0 / rest;
    }
    return q1 == 0 ? Rate{} : Rate{p1, q1};
  }

  double hz() const { return static_cast<double>(num) / static_cast<double>(den); }
  bool known() const { return num > 0; }
  bf_rate c() const { return {num, den}; }

  bool operator==(const Rate& other) const { return num == other.num && den == other.den; }
  bool operator!=(const Rate& other) const { return !(*this == other); }

  /// This rate times up / down.
  Rate scaled(std::int64_t up, std::int64_t down) const {
    const std::int64_t g1 = std::gcd(num, down), g2 = std::gcd(up, den);
    return {(num / g1) * (up / g2), (den / g2) * (down / g1)};
  }
};

}  // namespace bodeflow
