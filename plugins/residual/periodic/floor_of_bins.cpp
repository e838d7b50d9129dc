#include "periodic/floor_of_bins.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kMostBands = 24, kLeastBands = 4, kLeastBinsOfBand = 15;
constexpr Eigen::Index kDifferences = 3;

/// The logarithm of the mean of exponential values, from the value in their middle. Its expectation, of the k-th smallest of n:
/// the cumulants sum_{i < k} (j - 1)! / (n - i)^j, j = 1, 2, 3 (A. Renyi, On the theory of order statistics, 1953), through the
/// first terms of the logarithm.
double log_level(std::vector<double> values) {
  const std::size_t n = values.size(), below = n / 2;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), middle, values.end());
  double mean = 0.0, second = 0.0, third = 0.0;
  for (std::size_t i = 0; i <= below; ++i) {
    const double one = 1.0 / static_cast<double>(n - i);
    mean += one;
    second += one * one;
    third += 2.0 * one * one * one;
  }
  return std::log(*middle / mean) + second / (2.0 * mean * mean) - third / (3.0 * mean * mean * mean);
}

Eigen::MatrixXd differences(Eigen::Index size) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index n = 0; n < kDifferences; ++n) d = (d.bottomRows(d.rows() - 1) - d.topRows(d.rows() - 1)).eval();
  return d;
}

/// The smoother S of least expected error of S l, l with these weights (one over variance).
Eigen::MatrixXd best_smoother(const Eigen::VectorXd& l, const Eigen::VectorXd& weight) {
  const Eigen::MatrixXd d = differences(l.size()), penalty = d.transpose() * d, w = weight.asDiagonal();
  Eigen::MatrixXd best;
  double least = std::numeric_limits<double>::infinity();
  for (int step = -4; step <= 16; ++step) {
    const double lambda = weight.mean() * std::pow(10.0, 0.5 * step);
    const Eigen::MatrixXd s = (w + lambda * penalty).ldlt().solve(w);
    const Eigen::VectorXd e = l - s * l;
    const double cp = e.dot(w * e) + 2.0 * s.trace();
    if (!(cp < least)) continue;
    least = cp;
    best = s;
  }
  return best;
}

/// Slopes at the points of a cubic that is monotone where they are.
Eigen::VectorXd monotone_slopes(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::Index n = x.size();
  const Eigen::VectorXd h = x.tail(n - 1) - x.head(n - 1);
  const Eigen::VectorXd rise = (y.tail(n - 1) - y.head(n - 1)).cwiseQuotient(h);
  Eigen::VectorXd slope(n);
  slope[0] = rise[0];
  slope[n - 1] = rise[n - 2];
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double a = rise[i - 1], b = rise[i];
    const double wa = 2.0 * h[i] + h[i - 1], wb = h[i] + 2.0 * h[i - 1];
    slope[i] = a * b > 0.0 ? (wa + wb) / (wa / a + wb / b) : 0.0;
  }
  return slope;
}

}  // namespace

Expected<FloorOfBins> FloorOfBins::make(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& power) {
  const Eigen::Index bins = power.size(), bands = std::min(kMostBands, bins / kLeastBinsOfBand);
  if (bands < kLeastBands) {
    return refused("the noise floor needs at least " + std::to_string(kLeastBands * kLeastBinsOfBand) +
                   " bins between the lines, found " + std::to_string(bins) + "; record more periods");
  }
  FloorOfBins floor;
  floor.middle_hz_.resize(bands);
  Eigen::VectorXd levels(bands), weight(bands);
  for (Eigen::Index b = 0; b < bands; ++b) {
    const Eigen::Index begin = b * bins / bands, end = (b + 1) * bins / bands;
    levels[b] = log_level({power.data() + begin, power.data() + end});
    if (!std::isfinite(levels[b]))
      return refused("most of the bins between the lines are 0: there is no noise, and so no noise floor");
    floor.middle_hz_[b] = frequency_hz.segment(begin, end - begin).mean();
    weight[b] = static_cast<double>(end - begin) * std::numbers::ln2 * std::numbers::ln2;
  }
  const Eigen::MatrixXd s = best_smoother(levels, weight);
  floor.level_ = s * levels;
  floor.covariance_ = s * weight.cwiseInverse().asDiagonal() * s.transpose();
  floor.slope_ = monotone_slopes(floor.middle_hz_, floor.level_);
  return floor;
}

double FloorOfBins::at(double f) const {
  const Eigen::Index last = middle_hz_.size() - 1;
  if (f <= middle_hz_[0]) return std::exp(level_[0] + slope_[0] * (f - middle_hz_[0]));
  if (f >= middle_hz_[last]) return std::exp(level_[last] + slope_[last] * (f - middle_hz_[last]));
  const Eigen::Index i = std::upper_bound(middle_hz_.begin(), middle_hz_.end(), f) - middle_hz_.begin() - 1;
  const double h = middle_hz_[i + 1] - middle_hz_[i], t = (f - middle_hz_[i]) / h, t2 = t * t, t3 = t2 * t;
  return std::exp((2.0 * t3 - 3.0 * t2 + 1.0) * level_[i] + (3.0 * t2 - 2.0 * t3) * level_[i + 1] +
                  (t3 - 2.0 * t2 + t) * h * slope_[i] + (t3 - t2) * h * slope_[i + 1]);
}

Eigen::VectorXd FloorOfBins::at(const Eigen::VectorXd& frequency_hz) const {
  return frequency_hz.unaryExpr([this](double f) { return at(f); });
}

double FloorOfBins::relative_variance(const Eigen::VectorXd& frequency_hz) const {
  return relative_variance(frequency_hz, Eigen::VectorXd::Ones(frequency_hz.size()));
}

double FloorOfBins::relative_variance(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& weight) const {
  if (frequency_hz.size() == 0) return 0.0;
  const Eigen::Index last = middle_hz_.size() - 1;
  Eigen::VectorXd part = Eigen::VectorXd::Zero(last + 1);
  for (Eigen::Index n = 0; n < frequency_hz.size(); ++n) {  // as if levels were joined by straight lines
    const double f = frequency_hz[n];
    const Eigen::Index above =
        std::clamp<Eigen::Index>(std::upper_bound(middle_hz_.begin(), middle_hz_.end(), f) - middle_hz_.begin(), 1, last);
    const double t = (f - middle_hz_[above - 1]) / (middle_hz_[above] - middle_hz_[above - 1]);
    part[above - 1] += weight[n] * (1.0 - t);
    part[above] += weight[n] * t;
  }
  part /= weight.sum();
  return part.dot(covariance_ * part);
}

}  // namespace bodeflow::residual
