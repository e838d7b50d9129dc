#include "sampled/block_statistics.hpp"

#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kBlocks = 40;

Eigen::VectorXd block_means(const Eigen::VectorXd& x) {
  Eigen::VectorXd means(kBlocks);
  for (Eigen::Index b = 0; b < kBlocks; ++b) {
    const Eigen::Index first = b * x.size() / kBlocks, next = (b + 1) * x.size() / kBlocks;
    means[b] = x.segment(first, next - first).mean();
  }
  return means;
}

}  // namespace

double block_deviates(const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  if (before.size() < kBlocks) return 0.0;
  const Eigen::VectorXd means = block_means(before.cwiseAbs2() - after.cwiseAbs2());
  const double mean = means.mean(), variance = (means.array() - mean).square().sum() / static_cast<double>(kBlocks - 1);
  if (mean == 0.0) return 0.0;
  if (!(variance > 0.0)) return std::copysign(std::numeric_limits<double>::infinity(), mean);
  return mean / std::sqrt(variance / static_cast<double>(kBlocks));
}

Drift drift_of(const Eigen::VectorXd& residual) {
  Drift d;
  if (residual.size() < kBlocks) return d;
  const Eigen::VectorXd means = block_means(residual);
  const Eigen::ArrayXd place = Eigen::ArrayXd::LinSpaced(kBlocks, -0.5, 0.5);
  const double power = place.square().sum();
  d.rise = (place * means.array()).sum() / power;
  const double rest = (means.array() - means.mean() - d.rise * place).square().sum() / static_cast<double>(kBlocks - 2);
  d.std = std::sqrt(rest / power);
  return d;
}

}  // namespace bodeflow::residual
