#include "line_correlation.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr Eigen::Index kLinesALag = 4;

}  // namespace

double LineCorrelation::lines_of_one() const {
  double sum = 1.0;
  for (std::size_t l = 1; l < lags.size(); ++l) sum += 2.0 * lags[l].squaredNorm() / lags[0].squaredNorm();
  return sum;
}

LineCorrelation line_correlation(const Lines& lines, const Structure& structure, const Estimate& estimate,
                                 Eigen::Index distance) {
  LineCorrelation c;
  if (distance == 0 || lines.size() < kLinesALag * (distance + 1)) return c;
  const Eigen::MatrixXcd r = error_directions(lines, structure, estimate).conjugate().cwiseProduct(residuals(lines, estimate));
  for (Eigen::Index l = 0; l <= distance; ++l)
    c.lags.push_back((r.topRows(lines.size() - l).transpose() * r.bottomRows(lines.size() - l).conjugate()) / lines.weight.sum());
  return c;
}

Eigen::MatrixXd score_covariance(const Lines& lines, const Structure& structure, const Estimate& estimate,
                                 const LineCorrelation& correlation, std::size_t lags, const Eigen::MatrixXcd& slopes) {
  const Eigen::MatrixXcd direction = error_directions(lines, structure, estimate);
  const Eigen::Index size = lines.size(), outputs = direction.cols();
  const Eigen::MatrixXcd turned = direction.reshaped().conjugate().asDiagonal() * slopes;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(slopes.cols(), slopes.cols());
  for (std::size_t lag = 0; lag < std::min(lags, correlation.lags.size()); ++lag) {
    const auto l = static_cast<Eigen::Index>(lag);
    for (Eigen::Index i = 0; i < outputs; ++i) {
      for (Eigen::Index j = 0; j < outputs; ++j) {
        const Eigen::MatrixXcd products =
            turned.middleRows(i * size, size - l).adjoint() * turned.middleRows(j * size + l, size - l);
        const Eigen::MatrixXd part = 0.5 * (correlation.lags[lag](i, j) * products).real();
        sum += part;
        if (l > 0) sum += part.transpose();
      }
    }
  }
  return 0.5 * (sum + sum.transpose());
}

double score_inflation(const Lines& lines, const Structure& structure, const Estimate& estimate,
                       const LineCorrelation& correlation) {
  if (!correlation.any()) return 1.0;
  const auto directions = tangent(lines, structure, estimate);
  if (!directions) return 1.0;
  const Eigen::MatrixXcd all = jacobian(lines, estimate);
  Eigen::MatrixXcd slopes(all.rows(), directions->cols() + (structure.estimate_delay ? 1 : 0));
  slopes.leftCols(directions->cols()) = all.leftCols(all.cols() - 1) * *directions;
  if (structure.estimate_delay) slopes.col(slopes.cols() - 1) = all.col(all.cols() - 1);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> information(stacked(slopes).transpose() * stacked(slopes));
  const double alone = information.solve(score_covariance(lines, structure, estimate, correlation, 1, slopes)).trace();
  const double together =
      information.solve(score_covariance(lines, structure, estimate, correlation, correlation.lags.size(), slopes)).trace();
  return alone > 0.0 && together > alone ? together / alone : 1.0;
}

}  // namespace bodeflow::maximum_likelihood
