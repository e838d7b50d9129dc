#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <numeric>
#include <vector>

namespace bodeflow::generators {

inline double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

inline std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
  return a;
}

/// What the last steps tell of a function's curvature: J. Nocedal, S. Wright, Numerical Optimization, 2nd ed., 2006,
/// algorithm 7.4.
class LimitedBfgs {
 public:
  /// After a step: how far it went and how the gradient changed. Steps without positive curvature are passed over.
  void add(std::vector<double> step, std::vector<double> change) {
    const double curvature = dot(step, change);
    if (!(curvature > 0)) return;
    if (pairs_.size() == kMemory) pairs_.pop_front();
    pairs_.push_back({std::move(step), std::move(change), curvature});
  }

  /// The step to try from here: -H gradient; before the first pair one whose longest entry is kFirstStep.
  std::vector<double> direction(const std::vector<double>& gradient) const {
    std::vector<double> d = gradient;
    std::vector<double> shares(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      shares[i] = dot(pairs_[i].step, d) / pairs_[i].curvature;
      for (std::size_t k = 0; k < d.size(); ++k) d[k] -= shares[i] * pairs_[i].change[k];
    }
    const double scale = first_scale(gradient);
    for (double& entry : d) entry *= -scale;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double share = -shares[i] - dot(pairs_[i].change, d) / pairs_[i].curvature;
      for (std::size_t k = 0; k < d.size(); ++k) d[k] += share * pairs_[i].step[k];
    }
    return d;
  }

 private:
  static constexpr std::size_t kMemory = 12;
  static constexpr double kFirstStep = 0.01;

  double first_scale(const std::vector<double>& gradient) const {
    if (!pairs_.empty()) return pairs_.back().curvature / dot(pairs_.back().change, pairs_.back().change);
    double longest = 0;
    for (const double entry : gradient) longest = std::max(longest, std::abs(entry));
    return longest > 0 ? kFirstStep / longest : 0.0;
  }

  struct Pair {
    std::vector<double> step, change;
    double curvature;
  };
  std::deque<Pair> pairs_;
};

}  // namespace bodeflow::generators
