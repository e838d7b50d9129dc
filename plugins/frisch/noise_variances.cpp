#include "noise_variances.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace bodeflow::frisch {

namespace {

// |yu|^2 may exceed uu yy by rounding (one window gives equality).
constexpr double kRounding = 1e-12;
// Heights that differ by less, relative to the greatest power, meet in one point of the envelope.
constexpr double kEqualHeight = 1e-14;
// The least step along the envelope, relative to its length; doubled each time it was needed, so the walk ends.
constexpr double kLeastStep = 1e-14;

// The arcs h_k(x) = b_k - c_k / (a_k - x), concave and falling.
struct Arcs {
  Eigen::VectorXd a, b, c;
  double mean_a = 0.0, mean_b = 0.0;

  Eigen::Index size() const { return a.size(); }
  double height(Eigen::Index k, double x) const { return b[k] - c[k] / (a[k] - x); }
  double slope(Eigen::Index k, double x) const { return -c[k] / ((a[k] - x) * (a[k] - x)); }
  double bend(Eigen::Index k, double x) const { return slope(k, x) / (a[k] - x); }  // half of h''
  /// What the cost is but for a constant and the number of lines.
  double product(double x1, double x2) const { return (mean_a - x1) * (mean_b - x2); }
};

Expected<Arcs> arcs_of(const PowerSpectra& s) {
  const Eigen::Index lines = s.lines();
  if (lines == 0) return refused("the spectra have no line");
  if (s.yy.size() != lines || s.yu.size() != lines) return refused("the spectra differ in their number of lines");
  Arcs arcs{s.uu, s.yy, s.yu.cwiseAbs2(), s.uu.mean(), s.yy.mean()};
  for (Eigen::Index k = 0; k < lines; ++k) {
    const std::string line = "line " + std::to_string(k) + " of the spectra";
    if (!std::isfinite(s.uu[k]) || !std::isfinite(s.yy[k]) || !std::isfinite(arcs.c[k])) return refused(line + " is not finite");
    if (!(s.uu[k] > 0.0) || !(s.yy[k] > 0.0)) return refused(line + " has no power");
    const double most = s.uu[k] * s.yy[k];
    if (arcs.c[k] > most * (1.0 + kRounding)) return refused(line + " is no covariance: |yu|^2 exceeds uu yy");
    arcs.c[k] = std::min(arcs.c[k], most);
  }
  return arcs;
}

// The least t > 0 with value(t) = p t^2 + q t + r, r <= 0, passing from below to above zero; infinity where there is none. Stable
// form of the quadratic's roots.
double rising_root(double p, double q, double r) {
  if (r > 0.0) r = 0.0;
  if (p == 0.0) return q > 0.0 ? -r / q : HUGE_VAL;
  const double discriminant = q * q - 4.0 * p * r;
  if (discriminant <= 0.0) return HUGE_VAL;
  const double s = -0.5 * (q + std::copysign(std::sqrt(discriminant), q));
  const double first = s / p, second = s != 0.0 ? r / s : 0.0;
  // The slope 2 p t + q is positive at the rising root: the greater one for p > 0, the lesser one for p < 0.
  const double rising = p > 0.0 ? std::max(first, second) : std::min(first, second);
  return rising >= 0.0 ? rising : HUGE_VAL;
}

// Where arc j dips below arc k beyond x, as the distance from x.
double next_crossing(const Arcs& arcs, Eigen::Index k, Eigen::Index j, double x, double within) {
  const double d = arcs.b[k] - arcs.b[j], p = arcs.a[k] - x, r = arcs.a[j] - x;
  // (h_k - h_j)(a_k - x)(a_j - x) at x + t.
  const double square = d, linear = arcs.c[k] - arcs.c[j] - d * (p + r), constant = d * p * r - arcs.c[k] * r + arcs.c[j] * p;
  const double at_end = (square * within + linear) * within + constant;
  const bool can_dip = square < 0.0 && linear > 0.0 && linear < -2.0 * square * within;  // a maximum on the way
  if (at_end <= 0.0 && !can_dip) return HUGE_VAL;
  return rising_root(square, linear, constant);
}

// The lowest arc just beyond x: by height, then slope, then curvature; `tolerance` is what counts as equal height.
Eigen::Index lowest_after(const Arcs& arcs, double x, double tolerance) {
  double least = arcs.height(0, x);
  for (Eigen::Index k = 1; k < arcs.size(); ++k) least = std::min(least, arcs.height(k, x));
  Eigen::Index best = -1;
  for (Eigen::Index k = 0; k < arcs.size(); ++k) {
    if (arcs.height(k, x) > least + tolerance) continue;
    if (best < 0 || arcs.slope(k, x) < arcs.slope(best, x) ||
        (arcs.slope(k, x) == arcs.slope(best, x) && arcs.bend(k, x) < arcs.bend(best, x))) {
      best = k;
    }
  }
  return best;
}

class BestPoint {
 public:
  explicit BestPoint(const Arcs& arcs) : arcs_(arcs) {}
  void offer(double x1) {
    double x2 = arcs_.height(0, x1);
    for (Eigen::Index k = 1; k < arcs_.size(); ++k) x2 = std::min(x2, arcs_.height(k, x1));
    offer(x1, std::max(x2, 0.0));
  }
  void offer(double x1, double x2) {
    const double value = arcs_.product(x1, x2);
    if (value < value_) value_ = value, x1_ = x1, x2_ = x2;
  }
  double x1() const { return x1_; }
  double x2() const { return x2_; }

 private:
  const Arcs& arcs_;
  double value_ = HUGE_VAL, x1_ = 0.0, x2_ = 0.0;
};

// The one point of an arc where the cost can have a minimum: q s^2 = p c, s = a_k - x, both p and q above 0.
void offer_stationary(const Arcs& arcs, Eigen::Index k, double from, double to, BestPoint& best) {
  const double p = arcs.mean_a - arcs.a[k], q = arcs.mean_b - arcs.b[k];
  if (!(p > 0.0) || !(q > 0.0)) return;
  const double x = arcs.a[k] - std::sqrt(p * arcs.c[k] / q);
  if (x > from && x < to) best.offer(x);
}

NoiseVariances walk(const Arcs& arcs) {
  double end = HUGE_VAL;  // where the envelope meets x2 = 0
  for (Eigen::Index k = 0; k < arcs.size(); ++k) end = std::min(end, arcs.a[k] - arcs.c[k] / arcs.b[k]);
  end = std::max(end, 0.0);
  BestPoint best(arcs);
  best.offer(end, 0.0);
  const double tolerance = kEqualHeight * arcs.b.maxCoeff();
  double least_step = kLeastStep * end;
  double x = 0.0;
  Eigen::Index k = lowest_after(arcs, x, 0.0);
  while (x < end) {
    best.offer(x);
    double next = end - x;
    for (Eigen::Index j = 0; j < arcs.size(); ++j) {
      if (j != k) next = std::min(next, next_crossing(arcs, k, j, x, next));
    }
    offer_stationary(arcs, k, x, x + next, best);
    // Arcs that touch, or that are equal but for rounding, must not hold the walk up.
    const bool moves = next >= least_step;
    x = std::min(x + (moves ? next : least_step), end);
    k = lowest_after(arcs, x, moves ? tolerance : 0.0);
    if (!moves) least_step *= 2.0;
  }
  return {best.x1(), best.x2(), 0.0};
}

PowerSpectra without(const PowerSpectra& s, const std::vector<Eigen::Index>& removed) {
  PowerSpectra rest;
  const auto count = s.lines() - static_cast<Eigen::Index>(removed.size());
  rest.uu.resize(count);
  rest.yy.resize(count);
  rest.yu.resize(count);
  Eigen::Index i = 0;
  for (Eigen::Index k = 0; k < s.lines(); ++k) {
    if (std::binary_search(removed.begin(), removed.end(), k)) continue;
    rest.uu[i] = s.uu[k];
    rest.yy[i] = s.yy[k];
    rest.yu[i++] = s.yu[k];
  }
  return rest;
}

}  // namespace

Eigen::VectorXd determinants(const PowerSpectra& s, const NoiseVariances& noise) {
  return (s.uu.array() - noise.input) * (s.yy.array() - noise.output) - s.yu.array().abs2();
}

Expected<NoiseVariances> noise_variances(const PowerSpectra& spectra) {
  const auto arcs = arcs_of(spectra);
  if (!arcs) return tl::make_unexpected(arcs.error());
  NoiseVariances noise = walk(*arcs);
  noise.cost = determinants(spectra, noise).sum();
  return noise;
}

Expected<FrischNoise> frisch_noise(const PowerSpectra& spectra, double fraction, OutlierMeasure measure) {
  if (!(fraction >= 0.0 && fraction < 1.0)) return refused("the fraction of lines to remove must be within 0 .. 1");
  FrischNoise noise;
  const auto first = noise_variances(spectra);
  if (!first) return tl::make_unexpected(first.error());
  noise.first = noise.second = *first;
  const auto count = static_cast<std::size_t>(std::lround(fraction * static_cast<double>(spectra.lines())));
  if (count == 0) return noise;
  if (count >= static_cast<std::size_t>(spectra.lines())) return refused("the fraction of lines to remove leaves no line");
  Eigen::ArrayXd distance = determinants(spectra, *first).array().abs();
  if (measure == OutlierMeasure::relative) distance /= (spectra.uu + spectra.yy).array().square();
  std::vector<Eigen::Index> order(static_cast<std::size_t>(spectra.lines()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index j) { return distance[i] < distance[j]; });
  noise.removed.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
  std::sort(noise.removed.begin(), noise.removed.end());
  const auto second = noise_variances(without(spectra, noise.removed));
  if (!second) return tl::make_unexpected(second.error());
  noise.second = *second;
  return noise;
}

}  // namespace bodeflow::frisch
