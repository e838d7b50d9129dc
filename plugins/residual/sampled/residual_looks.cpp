#include "sampled/residual_looks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kLeastInBin = 4, kBlocks = 40;

/// Standard error of the mean of `left` (their mean taken off), which stand at these rows in ascending order.
double error_of_mean(const Eigen::VectorXd& left, const std::vector<Eigen::Index>& rows, Eigen::Index farthest) {
  double sum = left.squaredNorm();
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    for (Eigen::Index j = i + 1; j < left.size(); ++j) {
      const Eigen::Index lag = rows[static_cast<std::size_t>(j)] - rows[static_cast<std::size_t>(i)];
      if (lag > farthest) break;
      sum += 2.0 * (1.0 - static_cast<double>(lag) / static_cast<double>(farthest + 1)) * left[i] * left[j];
    }
  }
  return std::sqrt(std::max(sum, 0.0)) / static_cast<double>(left.size());
}

}  // namespace

std::vector<std::vector<Eigen::Index>> bins_by_value(const Eigen::VectorXd& signal) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(signal.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return signal[a] < signal[b]; });
  const std::size_t bins = static_cast<std::size_t>(std::clamp<Eigen::Index>(signal.size() / kLeastInBin, 1, kMapBins));
  std::vector<std::vector<Eigen::Index>> found;
  std::size_t begin = 0;
  for (std::size_t b = 1; b <= bins && begin < order.size(); ++b) {
    std::size_t end = std::max(b * order.size() / bins, begin);
    while (end > begin && end < order.size() && signal[order[end]] == signal[order[end - 1]]) ++end;
    if (end == begin) continue;
    found.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(end));
    std::sort(found.back().begin(), found.back().end());
    begin = end;
  }
  return found;
}

Eigen::VectorXd slope_of(const Eigen::VectorXd& signal, double step_s, const Stretches& stretches) {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(signal.size());
  for (const Stretch& s : stretches) {
    const Eigen::Index last = s.first + s.count - 1;
    for (Eigen::Index n = s.first; n <= last; ++n) {
      const Eigen::Index from = std::max(n - 1, s.first), to = std::min(n + 1, last);
      if (to > from) slope[n] = (signal[to] - signal[from]) / (static_cast<double>(to - from) * step_s);
    }
  }
  return slope;
}

MeanMap mean_map(const Eigen::VectorXd& residual, const Eigen::VectorXd& signal) {
  const auto farthest = static_cast<Eigen::Index>(1.5 * std::cbrt(static_cast<double>(residual.size())));
  const std::vector<std::vector<Eigen::Index>> bins = bins_by_value(signal);
  const auto count = static_cast<Eigen::Index>(bins.size());
  MeanMap map{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index b = 0; b < count; ++b) {
    const std::vector<Eigen::Index>& rows = bins[static_cast<std::size_t>(b)];
    Eigen::VectorXd left = residual(rows);
    map.at[b] = signal(rows).mean();
    map.mean[b] = left.mean();
    left.array() -= map.mean[b];
    map.std[b] = error_of_mean(left, rows, farthest);
  }
  return map;
}

ResidualCourse course_by_blocks(const Eigen::VectorXd& residual, const Eigen::VectorXd& time_s) {
  const Eigen::Index blocks = std::min(kBlocks, residual.size());
  ResidualCourse course;
  course.axis = "time";
  course.at.resize(blocks);
  course.rms.resize(blocks);
  for (Eigen::Index b = 0; b < blocks; ++b) {
    const Eigen::Index first = b * residual.size() / blocks, count = (b + 1) * residual.size() / blocks - first;
    course.at[b] = time_s.segment(first, count).mean();
    course.rms[b] = residual.segment(first, count).norm() / std::sqrt(static_cast<double>(count));
  }
  return course;
}

Autocorrelation autocorrelation(const Eigen::VectorXd& residual, double step_s, const Stretches& stretches) {
  Autocorrelation a;
  Eigen::Index shortest = residual.size();
  for (const Stretch& s : stretches) shortest = std::min(shortest, s.count);
  const Eigen::Index lags = std::min(kViewedLags, shortest / 4);
  const double power = residual.squaredNorm();
  if (lags < 1 || !(power > 0.0)) return a;
  a.band = kBand95 / std::sqrt(static_cast<double>(residual.size()));
  a.lag_s.resize(lags);
  a.value.resize(lags);
  for (Eigen::Index lag = 1; lag <= lags; ++lag) {
    double sum = 0.0;
    for (const Stretch& s : stretches) {
      const Eigen::Index pairs = s.count - lag;
      sum += residual.segment(s.first, pairs).dot(residual.segment(s.first + lag, pairs));
    }
    a.lag_s[lag - 1] = static_cast<double>(lag) * step_s;
    a.value[lag - 1] = sum / power;
  }
  return a;
}

}  // namespace bodeflow::residual
