#include "elimination.hpp"

#include <Eigen/QR>

#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {

Eigen::VectorXd shared_weights(const Data& data) {
  return (data.weights.rowwise().squaredNorm() / static_cast<double>(data.weights.cols())).cwiseSqrt();
}

Elimination::Elimination(const Data& data, const Eigen::VectorXd& shared, const Eigen::MatrixXd& columns, bool orthonormal) {
  ratios_ = Eigen::MatrixXd::Zero(data.lines(), data.weights.cols());
  for (Eigen::Index k = 0; k < data.lines(); ++k) {
    if (shared[k] > 0.0) ratios_.row(k) = data.weights.row(k) / shared[k];
  }
  if (data.common_weights() && orthonormal) {
    spans_.push_back(columns);
    return;
  }
  for (Eigen::Index i = 0; i < data.weights.cols(); ++i) {
    const Eigen::VectorXd twice = ratios_.col(i).replicate(2, 1);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(twice.asDiagonal() * columns);
    const Eigen::Index n = columns.cols();
    spans_.emplace_back(qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), n));
    triangles_.emplace_back(qr.matrixQR().topRows(n).triangularView<Eigen::Upper>());
  }
}

void Elimination::reduce(Eigen::Index channel, Eigen::MatrixXd& stacked) const {
  const Eigen::MatrixXd& span = spans_[at(channel)];
  const Eigen::MatrixXd part = span.transpose() * stacked;
  stacked.noalias() -= span * part;
}

Eigen::VectorXd Elimination::coefficients(Eigen::Index channel, const Eigen::VectorXd& stacked) const {
  Eigen::VectorXd b = spans_[at(channel)].transpose() * stacked;
  if (!triangles_.empty()) triangles_[at(channel)].triangularView<Eigen::Upper>().solveInPlace(b);
  return b;
}

Eigen::VectorXd Elimination::ratio(Eigen::Index channel) const { return ratios_.col(ratios_.cols() == 1 ? 0 : channel); }

Eigen::MatrixXd condensed(const Elimination& elimination, const Eigen::MatrixXcd& factors, const Eigen::MatrixXd& columns,
                          const Eigen::MatrixXd& extra) {
  const Eigen::Index n = columns.cols() + (extra.size() > 0 ? 1 : 0), rows = columns.rows();
  Eigen::MatrixXd work(n + rows, n), left(rows, n);
  work.topRows(n).setZero();
  for (Eigen::Index i = 0; i < factors.cols(); ++i) {
    left.leftCols(columns.cols()) = multiplied(factors.col(i), columns);
    if (extra.size() > 0) left.col(n - 1) = extra.col(i);
    elimination.reduce(i, left);
    work.bottomRows(rows) = left;
    Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(work);
    work.topRows(n).triangularView<Eigen::StrictlyLower>().setZero();
  }
  return work.topRows(n);
}

}  // namespace bodeflow::sanathanan_koerner
