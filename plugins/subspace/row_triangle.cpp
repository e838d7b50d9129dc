#include "row_triangle.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace bodeflow::subspace {

void RowTriangle::add(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd stack(R_.rows() + rows.rows(), R_.cols());
  stack << R_, rows;
  const Eigen::Index height = std::min(stack.rows(), stack.cols());
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(stack);
  R_ = stack.topRows(height).triangularView<Eigen::Upper>();
}

}  // namespace bodeflow::subspace
