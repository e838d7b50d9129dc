#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "frisch/noise_variances.hpp"

/// Slow and independent ways to the Frisch scheme's variances, to hold the walk against.
namespace bodeflow::test {

/// The output noise on the envelope above an input noise.
inline double envelope(const frisch::PowerSpectra& s, double x1) {
  double least = HUGE_VAL;
  for (Eigen::Index k = 0; k < s.lines(); ++k) least = std::min(least, s.yy[k] - std::norm(s.yu[k]) / (s.uu[k] - x1));
  return std::max(least, 0.0);
}

inline double envelope_end(const frisch::PowerSpectra& s) {
  double end = HUGE_VAL;
  for (Eigen::Index k = 0; k < s.lines(); ++k) end = std::min(end, s.uu[k] - std::norm(s.yu[k]) / s.yy[k]);
  return std::max(end, 0.0);
}

inline double frisch_cost(const frisch::PowerSpectra& s, double x1, double x2) {
  return frisch::determinants(s, {x1, x2, 0.0}).sum();
}

/// The least cost over all crossings of two arcs, all stationary points and both ends: O(lines^3).
inline double least_cost_by_enumeration(const frisch::PowerSpectra& s) {
  const double end = envelope_end(s), a_mean = s.uu.mean(), b_mean = s.yy.mean();
  std::vector<double> candidates = {0.0, end};
  const auto c = [&](Eigen::Index k) { return std::norm(s.yu[k]); };
  for (Eigen::Index k = 0; k < s.lines(); ++k) {
    const double p = a_mean - s.uu[k], q = b_mean - s.yy[k];
    if (p * q > 0.0) candidates.push_back(s.uu[k] - std::sqrt(p * c(k) / q));
    for (Eigen::Index j = 0; j < k; ++j) {
      // d (a_k - x)(a_j - x) - c_k (a_j - x) + c_j (a_k - x) = 0 as a polynomial in x.
      const double d = s.yy[k] - s.yy[j];
      const double linear = -d * (s.uu[k] + s.uu[j]) + c(k) - c(j),
                   constant = d * s.uu[k] * s.uu[j] - c(k) * s.uu[j] + c(j) * s.uu[k];
      const double root = std::sqrt(std::max(linear * linear - 4.0 * d * constant, 0.0));
      const double stable = -0.5 * (linear + std::copysign(root, linear));
      if (d != 0.0) candidates.push_back(stable / d);
      if (stable != 0.0) candidates.push_back(constant / stable);
    }
  }
  double least = frisch_cost(s, end, 0.0);
  for (const double x : candidates) {
    if (x >= 0.0 && x < end) least = std::min(least, frisch_cost(s, x, envelope(s, x)));
  }
  return least;
}

inline double least_cost_on_grid(const frisch::PowerSpectra& s, int points) {
  const double end = envelope_end(s);
  double least = frisch_cost(s, end, 0.0);
  for (int i = 0; i < points; ++i) {
    const double x = end * i / points;
    least = std::min(least, frisch_cost(s, x, envelope(s, x)));
  }
  return least;
}

}  // namespace bodeflow::test
