#include "distortion.hpp"

#include <algorithm>
#include <cmath>

#include "lines.hpp"

namespace bodeflow::spectrum {
namespace {

/// rms over the experiments of |mean| at a line for `count` signals from `first`.
Eigen::RowVectorXd level_at(const Measured& measured, Eigen::Index k, Eigen::Index first, Eigen::Index count) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(count);
  for (const Moments& m : measured.parts) sum += m.mean.row(k).segment(first, count).cwiseAbs2();
  return (sum / static_cast<double>(measured.parts.size())).cwiseSqrt();
}

Eigen::RowVectorXd noise_at(const Measured& measured, Eigen::Index k, Eigen::Index first, Eigen::Index count) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(count);
  for (const Moments& m : measured.parts) sum += m.variance.row(k).segment(first, count);
  return (sum / static_cast<double>(measured.parts.size())).cwiseSqrt();
}

}  // namespace

Levels levels_of(const Measured& measured, const std::vector<std::int64_t>& estimated, std::int64_t first, std::int64_t last) {
  const Layout& l = measured.layout;
  Levels levels;
  const auto count = static_cast<Eigen::Index>(last - first + 1);
  Eigen::VectorXd power = Eigen::VectorXd::Zero(count);
  for (std::size_t m = 0; m < measured.realisations(); ++m) {
    power = power.cwiseMax(excitation_of(measured, m).power.segment(first, count));
  }
  const double least = kExcited * kExcited * power.maxCoeff();
  levels.input_level.resize(count, l.inputs);
  levels.output_level.resize(count, l.outputs);
  if (measured.has_noise()) {
    levels.input_noise.resize(count, l.inputs);
    levels.output_noise.resize(count, l.outputs);
  }
  for (Eigen::Index row = 0; row < count; ++row) {
    const std::int64_t k = first + row;
    const bool driven = power[row] >= least || std::binary_search(estimated.begin(), estimated.end(), k);
    levels.lines.push_back(k);
    levels.kind.push_back(driven ? Levels::excited : k % 2 != 0 ? Levels::odd : Levels::even);
    levels.input_level.row(row) = level_at(measured, k, 0, l.inputs);
    levels.output_level.row(row) = level_at(measured, k, l.inputs, l.outputs);
    if (!measured.has_noise()) continue;
    levels.input_noise.row(row) = noise_at(measured, k, 0, l.inputs);
    levels.output_noise.row(row) = noise_at(measured, k, l.inputs, l.outputs);
  }
  return levels;
}

KindLevel rms_of(const Levels& levels, Levels::Kind kind) {
  KindLevel r;
  r.level = Eigen::VectorXd::Zero(levels.output_level.cols());
  for (std::size_t i = 0; i < levels.kind.size(); ++i) {
    if (levels.kind[i] != kind) continue;
    ++r.lines;
    r.level += levels.output_level.row(static_cast<Eigen::Index>(i)).cwiseAbs2().transpose();
  }
  if (r.lines > 0) r.level = (r.level / static_cast<double>(r.lines)).cwiseSqrt().eval();
  return r;
}

Eigen::VectorXd rms_noise(const Levels& levels) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(levels.output_noise.cols());
  double lines = 0.0;
  for (std::size_t i = 0; i < levels.kind.size(); ++i) {
    if (levels.kind[i] == Levels::excited) continue;
    lines += 1.0;
    sum += levels.output_noise.row(static_cast<Eigen::Index>(i)).cwiseAbs2().transpose();
  }
  if (lines == 0.0)
    return levels.output_noise.colwise().squaredNorm().cwiseSqrt() / std::sqrt(static_cast<double>(levels.lines.size()));
  return (sum / lines).cwiseSqrt();
}

Eigen::MatrixXd level_beside(const Levels& levels, const std::vector<std::int64_t>& lines, Levels::Kind kind) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < levels.kind.size(); ++i) {
    if (levels.kind[i] == kind) rows.push_back(i);
  }
  if (rows.empty()) return {};
  const auto square = [&](std::size_t row) { return levels.output_level.row(static_cast<Eigen::Index>(row)).cwiseAbs2(); };
  Eigen::MatrixXd result(static_cast<Eigen::Index>(lines.size()), levels.output_level.cols());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto above = std::lower_bound(rows.begin(), rows.end(), lines[i],
                                        [&](std::size_t row, std::int64_t k) { return levels.lines[row] < k; });
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(result.cols());
    double count = 0.0;
    if (above != rows.end()) sum += square(*above), count += 1.0;
    if (above != rows.begin()) sum += square(*(above - 1)), count += 1.0;
    result.row(static_cast<Eigen::Index>(i)) = (sum / count).cwiseSqrt();
  }
  return result;
}

}  // namespace bodeflow::spectrum
