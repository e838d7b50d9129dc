#include "residual_classes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

double multiple(double mean_square) { return std::sqrt(std::max(mean_square, 0.0)); }

std::optional<ClassTest> test_lines(const char* name, const std::vector<Eigen::Index>& lines, const Experiment& e,
                                    const Prediction& p, const Eigen::MatrixXd& covariance, bool fitted) {
  if (lines.empty()) return {};
  Eigen::Index rows = 0;
  for (const Eigen::Index k : lines) rows += rows_of(k).count;
  Eigen::VectorXd r(rows), frequency(static_cast<Eigen::Index>(lines.size()));
  Eigen::MatrixXd j(rows, p.jacobian.cols());
  Eigen::Index at = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const Rows from = rows_of(lines[n]);
    r.segment(at, from.count) = p.residual.segment(from.begin, from.count);
    j.middleRows(at, from.count) = p.jacobian.middleRows(from.begin, from.count);
    at += from.count;
    frequency[static_cast<Eigen::Index>(n)] = e.frequency_hz[lines[n]];
  }
  double sum = r.squaredNorm(), freedom = static_cast<double>(rows);
  if (fitted) {
    freedom -= (j.transpose() * j * covariance).trace();
  } else {
    const Eigen::VectorXd b = j.transpose() * r;
    const Eigen::MatrixXd middle = Eigen::MatrixXd::Identity(b.size(), b.size()) + covariance * (j.transpose() * j);
    sum -= b.dot(middle.partialPivLu().solve(covariance * b));
  }
  if (freedom < 0.5) return {};
  const double ratio = sum / freedom;
  return ClassTest{name, multiple(ratio), f_tail(ratio, freedom, 2.0 / e.floor.relative_variance(frequency))};
}

std::optional<ClassTest> test_skirts(const Experiment& e) {
  Eigen::VectorXd frequency(std::count(e.skirt.begin(), e.skirt.end(), true));
  if (frequency.size() == 0) return {};
  double sum = 0.0;
  for (Eigen::Index l = 0, n = 0; l < e.between.size(); ++l) {
    if (!e.skirt[static_cast<std::size_t>(l)]) continue;
    sum += e.between[l];
    frequency[n++] = e.between_hz[l];
  }
  const auto count = static_cast<double>(frequency.size());
  return ClassTest{"skirts", multiple(sum / count), f_tail(sum / count, 2.0 * count, 2.0 / e.floor.relative_variance(frequency))};
}

std::optional<ClassTest> test_peak(const Experiment& e) {
  if (e.between.size() == 0) return {};
  const double highest = e.between.maxCoeff(), bins = static_cast<double>(e.between.size());
  return ClassTest{"peak", multiple(highest), -std::expm1(bins * std::log1p(-std::exp(-highest)))};
}

}  // namespace

std::vector<ClassTest> test_classes(const Experiment& e, const Prediction& p, const Eigen::MatrixXd& covariance, bool fitted) {
  std::vector<ClassTest> tests;
  const auto keep = [&tests](std::optional<ClassTest> test) {
    if (test) tests.push_back(std::move(*test));
  };
  for (const auto& [kind, name] :
       {std::pair{Kind::excited, "excited"}, {Kind::odd, "odd"}, {Kind::even, "even"}, {Kind::dc, "dc"}}) {
    std::vector<Eigen::Index> lines;
    for (Eigen::Index k = 0; k < e.lines(); ++k)
      if (e.kind[static_cast<std::size_t>(k)] == kind) lines.push_back(k);
    keep(test_lines(name, lines, e, p, covariance, fitted));
  }
  keep(test_skirts(e));
  keep(test_peak(e));
  return tests;
}

}  // namespace bodeflow::residual
