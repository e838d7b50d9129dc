#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodeflow::numerics {

/// Orthogonal factorisation of rows under an upper triangle: Q' [R; Y] = [R'; 0].
///
/// Method: Householder reflections that leave the zeros of the triangle out of the work, in panels whose effect on the rest is a
/// matrix product. With R = 0 it is the factorisation of Y alone, and `apply` then splits other rows into what the columns of Y
/// explain and what they leave. Cost: 2 rows columns^2 operations. Sums have one order on every machine. Source: R. Schreiber, C.
/// Van Loan, A storage-efficient WY representation for products of Householder transformations, SIAM J. Scientific and
/// Statistical Computing 10, 1989, doi:10.1137/0910005.
class StackedQr {
 public:
  /// triangle: columns x columns, what is below its diagonal is not looked at. rows: any number x columns.
  StackedQr(Eigen::MatrixXd triangle, Eigen::MatrixXd rows);

  /// R', with zeros below its diagonal.
  const Eigen::MatrixXd& triangle() const { return triangle_; }

  /// [top; bottom] <- Q' [top; bottom]: top has as many rows as the triangle, bottom as many as Y.
  void apply(Eigen::Ref<Eigen::MatrixXd> top, Eigen::Ref<Eigen::MatrixXd> bottom) const;

 private:
  Eigen::MatrixXd triangle_, reflectors_;
  std::vector<Eigen::MatrixXd> panels_;  // upper triangles T of I - V T V'
};

/// Y is taken into the triangle: R becomes R' of the class above; Y is spent.
void fold_rows(Eigen::MatrixXd& triangle, Eigen::Ref<Eigen::MatrixXd> rows);

}  // namespace bodeflow::numerics
