#include "noise_floor.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kMostBands = 12;
constexpr Eigen::Index kLeastBinsOfBand = 15;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Expected<NoiseFloor> NoiseFloor::from_bins(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXd& power) {
  const Eigen::Index bins = power.size(), bands = std::min(kMostBands, bins / kLeastBinsOfBand);
  if (bands <= kTerms) {
    return refused("the noise floor needs at least " + std::to_string((kTerms + 1) * kLeastBinsOfBand) +
                   " bins between the lines, found " + std::to_string(bins) + "; record more periods");
  }
  NoiseFloor floor;
  floor.low_hz_ = frequency_hz[0];
  floor.high_hz_ = frequency_hz[bins - 1];
  Eigen::MatrixXd a(bands, kTerms);
  Eigen::VectorXd level(bands);
  for (Eigen::Index b = 0; b < bands; ++b) {
    const Eigen::Index begin = b * bins / bands, end = (b + 1) * bins / bands;
    const double middle = median({power.data() + begin, power.data() + end}) / std::numbers::ln2;
    if (!(middle > 0.0)) return refused("most of the bins between the lines are 0: there is no noise, and so no noise floor");
    const double weight = std::sqrt(static_cast<double>(end - begin)) * std::numbers::ln2;
    a.row(b) = weight * floor.basis(frequency_hz.segment(begin, end - begin).mean()).transpose();
    level[b] = weight * std::log(middle);
  }
  floor.coefficients_ = a.colPivHouseholderQr().solve(level);
  floor.covariance_ = (a.transpose() * a).inverse();
  return floor;
}

Eigen::Vector3d NoiseFloor::basis(double frequency_hz) const {
  const double x = 2.0 * (frequency_hz - low_hz_) / (high_hz_ - low_hz_) - 1.0;
  return {1.0, x, 1.5 * x * x - 0.5};
}

double NoiseFloor::at(double frequency_hz) const { return std::exp(coefficients_.dot(basis(frequency_hz))); }

Eigen::VectorXd NoiseFloor::at(const Eigen::VectorXd& frequency_hz) const {
  return frequency_hz.unaryExpr([this](double f) { return at(f); });
}

double NoiseFloor::relative_variance(const Eigen::VectorXd& frequency_hz) const {
  if (frequency_hz.size() == 0) return 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const double f : frequency_hz) mean += basis(f);
  mean /= static_cast<double>(frequency_hz.size());
  return mean.dot(covariance_ * mean);
}

}  // namespace bodeflow::residual
