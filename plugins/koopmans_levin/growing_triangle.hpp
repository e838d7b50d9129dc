#pragma once

#include <Eigen/QR>

namespace bodeflow::koopmans_levin {

/// An upper triangle R to which rows are appended in blocks: R^T R is the sum of their products. Memory: one block.
class GrowingTriangle {
 public:
  GrowingTriangle(Eigen::Index columns, Eigen::Index block_rows)
      : stacked_(Eigen::MatrixXd::Zero(block_rows + columns, columns)), columns_(columns) {}

  /// Where up to block_rows further rows are written before `append`.
  auto rows(Eigen::Index count) { return stacked_.middleRows(columns_, count); }

  void append(Eigen::Index count) {
    qr_.compute(stacked_.topRows(columns_ + count));
    stacked_.topRows(columns_) = qr_.matrixQR().topRows(columns_).triangularView<Eigen::Upper>().toDenseMatrix();
  }

  Eigen::MatrixXd triangle() const { return stacked_.topRows(columns_); }

 private:
  Eigen::MatrixXd stacked_;
  Eigen::Index columns_;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
};

}  // namespace bodeflow::koopmans_levin
