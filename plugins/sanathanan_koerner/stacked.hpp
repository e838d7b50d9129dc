#pragma once

#include <Eigen/Core>

/// Complex columns as real ones of twice the length: real parts, then imaginary parts. Their inner product is the real part of
/// the complex one.
namespace bodeflow::sanathanan_koerner {

inline Eigen::VectorXd stacked(const Eigen::VectorXcd& x) {
  Eigen::VectorXd s(2 * x.size());
  s << x.real(), x.imag();
  return s;
}

inline Eigen::VectorXcd unstacked(const Eigen::VectorXd& s) {
  const Eigen::Index n = s.size() / 2;
  Eigen::VectorXcd x(n);
  x.real() = s.head(n);
  x.imag() = s.tail(n);
  return x;
}

/// Each stacked column multiplied, line by line, by the complex factors.
inline Eigen::MatrixXd multiplied(const Eigen::VectorXcd& factors, const Eigen::MatrixXd& columns) {
  const Eigen::Index n = factors.size();
  Eigen::MatrixXd product(columns.rows(), columns.cols());
  const Eigen::ArrayXd re = factors.real().array(), im = factors.imag().array();
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const auto x = columns.col(j).head(n).array(), y = columns.col(j).tail(n).array();
    product.col(j).head(n) = re * x - im * y;
    product.col(j).tail(n) = im * x + re * y;
  }
  return product;
}

}  // namespace bodeflow::sanathanan_koerner
