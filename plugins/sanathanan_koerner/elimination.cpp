#include "elimination.hpp"

#include <bodeflow/numerics/products.hpp>

#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {

Eigen::VectorXd shared_weights(const Data& data) {
  return (data.weights.rowwise().squaredNorm() / static_cast<double>(data.weights.cols())).cwiseSqrt();
}

Elimination::Elimination(const Data& data, const Eigen::VectorXd& shared, const Eigen::MatrixXd& columns, bool orthonormal)
    : span_(columns.data(), columns.rows(), columns.cols()) {
  ratios_ = Eigen::MatrixXd::Zero(data.lines(), data.weights.cols());
  for (Eigen::Index k = 0; k < data.lines(); ++k) {
    if (shared[k] > 0.0) ratios_.row(k) = data.weights.row(k) / shared[k];
  }
  if (data.common_weights() && orthonormal) return;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  for (Eigen::Index i = 0; i < data.weights.cols(); ++i)
    factors_.emplace_back(none, ratios_.col(i).replicate(2, 1).asDiagonal() * columns);
}

const numerics::StackedQr& Elimination::factor(Eigen::Index channel) const {
  return factors_[factors_.size() == 1 ? 0 : static_cast<std::size_t>(channel)];
}

void Elimination::reduce(Eigen::Index channel, Eigen::MatrixXd& stacked) const {
  if (factors_.empty()) {
    numerics::add_product(stacked, span_, numerics::transposed_product(span_, stacked), -1.0);
    return;
  }
  Eigen::MatrixXd explained = Eigen::MatrixXd::Zero(span_.cols(), stacked.cols());
  factor(channel).apply(explained, stacked);
}

Eigen::VectorXd Elimination::coefficients(Eigen::Index channel, const Eigen::VectorXd& stacked) const {
  if (factors_.empty()) return numerics::transposed_times(span_, stacked);
  Eigen::MatrixXd explained = Eigen::MatrixXd::Zero(span_.cols(), 1), left = stacked;
  factor(channel).apply(explained, left);
  return factor(channel).triangle().triangularView<Eigen::Upper>().solve(explained.col(0));
}

Eigen::VectorXd Elimination::ratio(Eigen::Index channel) const { return ratios_.col(ratios_.cols() == 1 ? 0 : channel); }

Eigen::MatrixXd condensed(const Elimination& elimination, const Eigen::MatrixXcd& factors, const Eigen::MatrixXd& columns,
                          const Eigen::MatrixXd& extra) {
  const Eigen::Index n = columns.cols() + (extra.size() > 0 ? 1 : 0);
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(n, n), left(columns.rows(), n);
  for (Eigen::Index i = 0; i < factors.cols(); ++i) {
    left.leftCols(columns.cols()) = multiplied(factors.col(i), columns);
    if (extra.size() > 0) left.col(n - 1) = extra.col(i);
    elimination.reduce(i, left);
    numerics::fold_rows(triangle, left);
  }
  return triangle;
}

}  // namespace bodeflow::sanathanan_koerner
