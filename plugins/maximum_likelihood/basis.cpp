#include "basis.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

constexpr double kBreakdown = 1e-12;  // what is left of x q_j after orthogonalisation, relative: below it is rounding

}  // namespace

Expected<Basis> Basis::orthonormal(const Eigen::VectorXcd& points, const Eigen::VectorXd& weights, Eigen::Index degree) {
  Basis b;
  const double length = weights.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return refused("the lines have no weight, or an infinite one");
  b.first_ = 1.0 / length;
  b.weights_ = weights;
  b.recurrence_ = Eigen::MatrixXd::Zero(degree + 1, degree);
  b.values_.resize(points.size(), degree + 1);
  b.values_.col(0).setConstant(b.first_);
  const Eigen::VectorXd squares = weights.cwiseAbs2();
  for (Eigen::Index j = 0; j < degree; ++j) {
    Eigen::VectorXcd next = points.cwiseProduct(b.values_.col(j));
    const double before = weights.cwiseProduct(next.cwiseAbs()).norm();
    for (int pass = 0; pass < 2; ++pass) {
      const auto found = b.values_.leftCols(j + 1);
      const Eigen::VectorXd share = (found.adjoint() * squares.cwiseProduct(next)).real();
      next -= found * share;
      b.recurrence_.col(j).head(j + 1) += share;
    }
    const double left = weights.cwiseProduct(next.cwiseAbs()).norm();
    if (!(left > kBreakdown * before)) {
      return refused(std::to_string(points.size()) + " lines do not determine a polynomial of degree " + std::to_string(degree));
    }
    b.recurrence_(j + 1, j) = left;
    b.values_.col(j + 1) = next / left;
  }
  return b;
}

Eigen::VectorXcd Basis::at(Complex x) const {
  Eigen::VectorXcd q(size());
  q[0] = first_;
  for (Eigen::Index j = 0; j < degree(); ++j) {
    Complex next = x * q[j];
    for (Eigen::Index i = 0; i <= j; ++i) next -= recurrence_(i, j) * q[i];
    q[j + 1] = next / recurrence_(j + 1, j);
  }
  return q;
}

Eigen::MatrixXd Basis::monomials() const {
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(size(), size());
  t(0, 0) = first_;
  for (Eigen::Index j = 0; j < degree(); ++j) {
    t.col(j + 1).tail(degree()) = t.col(j).head(degree());
    t.col(j + 1) -= t.leftCols(j + 1) * recurrence_.col(j).head(j + 1);
    t.col(j + 1) /= recurrence_(j + 1, j);
  }
  return t;
}

Eigen::VectorXd Basis::coefficients(const Eigen::VectorXcd& values) const {
  return (values_.adjoint() * weights_.cwiseAbs2().cwiseProduct(values)).real();
}

Eigen::VectorXcd Basis::roots(const Eigen::VectorXd& c) const {
  Eigen::Index n = degree();
  while (n > 0 && c[n] == 0.0) --n;
  if (n == 0) return {};
  Eigen::MatrixXd m = recurrence_.topLeftCorner(n, n);
  m.col(n - 1) -= recurrence_(n, n - 1) / c[n] * c.head(n);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(m, false);
  std::vector<Complex> upper;
  for (const Complex& x : solver.eigenvalues()) {
    if (x.imag() >= 0.0) upper.push_back(x);
  }
  std::stable_sort(upper.begin(), upper.end(), [](Complex a, Complex b) { return std::abs(a) < std::abs(b); });
  Eigen::VectorXcd found(n);
  Eigen::Index at = 0;
  for (const Complex& x : upper) {
    found[at++] = x;
    if (x.imag() > 0.0 && at < n) found[at++] = std::conj(x);
  }
  return found;
}

}  // namespace bodeflow::maximum_likelihood
