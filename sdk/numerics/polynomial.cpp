#include "bodeflow/numerics/polynomial.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bodeflow/numerics/balance.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;

// Typed numbers have few digits: a pair written to 10 digits is a pair.
constexpr double kConjugate = 1e-9;
constexpr double kReal = 1e-12;

std::string number(Complex value) {
  char text[64];
  std::snprintf(text, sizeof text, value.imag() == 0 ? "%g" : "%g%+gi", value.real(), value.imag());
  return text;
}

Eigen::MatrixXd companion(const Eigen::VectorXd& p) {
  const Eigen::Index order = p.size() - 1;
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(order, order);
  c.row(0) = -p.tail(order).transpose() / p[0];
  c.diagonal(-1).setOnes();
  return c;
}

bool by_magnitude(Complex a, Complex b) { return std::abs(a) < std::abs(b); }

}  // namespace

Eigen::VectorXd trimmed(const Eigen::VectorXd& polynomial) {
  Eigen::Index first = 0;
  while (first < polynomial.size() && polynomial[first] == 0) ++first;
  return polynomial.tail(polynomial.size() - first);
}

Complex evaluate(const Eigen::VectorXd& polynomial, Complex x) {
  Complex value = 0;
  for (Eigen::Index k = 0; k < polynomial.size(); ++k) value = value * x + polynomial[k];
  return value;
}

Eigen::VectorXd multiply(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() == 0 || b.size() == 0) return {};
  Eigen::VectorXd product = Eigen::VectorXd::Zero(a.size() + b.size() - 1);
  for (Eigen::Index k = 0; k < a.size(); ++k) product.segment(k, b.size()) += a[k] * b;
  return product;
}

Expected<Eigen::VectorXcd> roots(const Eigen::VectorXd& polynomial) {
  if (!polynomial.allFinite()) return refused("a coefficient of the polynomial is not a finite number");
  Eigen::VectorXd p = trimmed(polynomial);
  if (p.size() == 0) return refused("the polynomial is zero: every number is a root");
  Eigen::Index at_zero = 0;
  while (p[p.size() - 1 - at_zero] == 0) ++at_zero;
  p.conservativeResize(p.size() - at_zero);

  std::vector<Complex> found(static_cast<std::size_t>(at_zero), Complex(0));
  if (p.size() > 1) {
    const Eigen::MatrixXd c = companion(p);
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(scaled_by(c, balancing_scales(c)), false);
    if (!c.allFinite() || solver.info() != Eigen::Success)
      return refused("the eigenvalues of the companion matrix did not converge");
    std::vector<Complex> upper;
    for (const Complex& x : solver.eigenvalues()) {
      if (x.imag() >= 0) upper.push_back(x);
    }
    std::stable_sort(upper.begin(), upper.end(), by_magnitude);
    for (const Complex& x : upper) {
      found.push_back(x);
      if (x.imag() != 0) found.push_back(std::conj(x));
    }
  }
  return Eigen::Map<const Eigen::VectorXcd>(found.data(), static_cast<Eigen::Index>(found.size()));
}

Expected<RealRoots> split_roots(const Eigen::VectorXcd& roots) {
  RealRoots split;
  std::vector<Complex> lower;
  for (const Complex& x : roots) {
    if (!std::isfinite(x.real()) || !std::isfinite(x.imag())) return refused("a root is not a finite number");
    if (std::abs(x.imag()) <= kReal * std::abs(x)) {
      split.real.push_back(x.real());
    } else if (x.imag() > 0) {
      split.pairs.push_back(x);
    } else {
      lower.push_back(x);
    }
  }
  for (const Complex& x : split.pairs) {
    const auto nearest = std::min_element(lower.begin(), lower.end(), [&](Complex a, Complex b) {
      return std::abs(std::conj(a) - x) < std::abs(std::conj(b) - x);
    });
    if (nearest == lower.end() || std::abs(std::conj(*nearest) - x) > kConjugate * std::abs(x)) {
      return refused("the root " + number(x) + " stands without its conjugate " + number(std::conj(x)));
    }
    lower.erase(nearest);
  }
  if (!lower.empty()) {
    return refused("the root " + number(lower.front()) + " stands without its conjugate " + number(std::conj(lower.front())));
  }
  std::stable_sort(split.pairs.begin(), split.pairs.end(), by_magnitude);
  std::stable_sort(split.real.begin(), split.real.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return split;
}

Expected<Eigen::VectorXd> polynomial_from_roots(const Eigen::VectorXcd& roots) {
  const auto split = split_roots(roots);
  if (!split) return tl::make_unexpected(split.error());
  Eigen::VectorXd p = Eigen::VectorXd::Ones(1);
  for (const double x : split->real) p = multiply(p, Eigen::Vector2d(1, -x));
  for (const Complex& x : split->pairs) p = multiply(p, Eigen::Vector3d(1, -2 * x.real(), std::norm(x)));
  return p;
}

}  // namespace bodeflow::numerics
