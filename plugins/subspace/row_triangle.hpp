#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/stacked_qr.hpp>

namespace bodeflow::subspace {

/// The triangular factor R of a tall matrix whose rows come in blocks: R'R = A'A, by Householder reflections of [R; block], so
/// without the squared condition of A'A. Memory: R and one block.
class RowTriangle {
 public:
  explicit RowTriangle(Eigen::Index columns) : R_(Eigen::MatrixXd::Zero(columns, columns)) {}

  void add(Eigen::MatrixXd rows) { numerics::fold_rows(R_, rows); }
  /// columns x columns, upper triangular.
  const Eigen::MatrixXd& R() const { return R_; }

 private:
  Eigen::MatrixXd R_;
};

}  // namespace bodeflow::subspace
