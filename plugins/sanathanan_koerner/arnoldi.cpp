#include "arnoldi.hpp"

#include <bodeflow/numerics/products.hpp>
#include <cmath>
#include <string>

#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr double kNothingNew = 1e-14;  // share of z q_j outside the span of what is there: only rounding

}  // namespace

Expected<Basis> arnoldi(const Eigen::VectorXcd& z, const Eigen::VectorXd& weights, Eigen::Index order) {
  Basis b;
  b.scale = weights.norm();
  if (!(b.scale > 0.0) || !std::isfinite(b.scale)) return unexpected("the weights of the lines have no finite norm");
  const Eigen::Index lines = z.size();
  b.vectors.resize(2 * lines, order + 1);
  b.hessenberg = Eigen::MatrixXd::Zero(order + 1, order);
  b.vectors.col(0) = stacked(weights.cast<std::complex<double>>() / b.scale);
  Eigen::VectorXd u(2 * lines), h(order + 1);
  for (Eigen::Index j = 0; j < order; ++j) {
    u = multiplied(z, b.vectors.col(j));
    const auto known = b.vectors.leftCols(j + 1);
    for (int pass = 0; pass < 2; ++pass) {
      h.head(j + 1) = numerics::transposed_times(known, u);
      numerics::subtract_product(u, known, h.head(j + 1));
      b.hessenberg.col(j).head(j + 1) += h.head(j + 1);
    }
    const double rest = u.norm();
    if (!(rest > kNothingNew)) return unexpected("the lines allow no polynomial beyond degree " + std::to_string(j));
    b.hessenberg(j + 1, j) = rest;
    b.vectors.col(j + 1) = u / rest;
  }
  return b;
}

Eigen::MatrixXcd polynomials_at(const Basis& b, const Eigen::VectorXcd& z) {
  Eigen::MatrixXcd q(z.size(), b.order() + 1);
  q.col(0).setConstant(1.0 / b.scale);
  for (Eigen::Index j = 0; j < b.order(); ++j) {
    const Eigen::VectorXcd next =
        z.cwiseProduct(q.col(j)) - q.leftCols(j + 1) * b.hessenberg.col(j).head(j + 1).cast<std::complex<double>>();
    q.col(j + 1) = next / b.hessenberg(j + 1, j);
  }
  return q;
}

}  // namespace bodeflow::sanathanan_koerner
