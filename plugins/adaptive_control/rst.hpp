#pragma once

#include <array>
#include <complex>
#include <cstddef>

namespace bodeflow::adaptive_control {

inline constexpr int kMostOrder = 8;    ///< highest degree of R, S, T and the anti-windup polynomial
inline constexpr int kMostPoints = 16;  ///< most frequencies of fitting

/// Coefficients in descending powers of z, as many as the degree plus one.
using Coefficients = std::array<double, kMostOrder + 1>;

/// A controller R u = -S y + T u_c (2.5) with monic R.
struct Rst {
  int n_r = 0, n_s = 0, n_t = 0;
  Coefficients r{1.0}, s{}, t{};
};

/// p(x) of a polynomial of degree n by Horner's rule.
template <class X>
X value_at(const Coefficients& p, int n, X x) {
  X value = p[0];
  for (std::size_t i = 1; i <= static_cast<std::size_t>(n); ++i) value = value * x + p[i];
  return value;
}

/// u = gain (u_c - y) with the degrees of `like`.
inline Rst proportional(double gain, const Rst& like) {
  Rst start;
  start.n_r = like.n_r;
  start.n_s = like.n_s;
  start.n_t = like.n_t;
  start.s[0] = start.t[0] = gain;
  return start;
}

}  // namespace bodeflow::adaptive_control
