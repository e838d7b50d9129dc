#include "bodeflow/numerics/polynomial.hpp"

#include <Eigen/Dense>
#include <limits>

#include "bodeflow/numerics/balance.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;
using Complex = std::complex<double>;

namespace {

Eigen::VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

double relative(Complex found, Complex expected) { return std::abs(found - expected) / std::abs(expected); }

}  // namespace

TEST_CASE("roots of a polynomial with known roots are found to rounding, sorted, in conjugate pairs") {
  // (x - 1)(x^2 + 2 x + 5)(x + 100), roots 1, -1 +- 2i, -100
  const Eigen::VectorXd p = multiply(multiply(vector({1, -1}), vector({1, 2, 5})), vector({3, 300}));
  const auto x = roots(p);
  REQUIRE(x);
  REQUIRE(x->size() == 4);
  CHECK(relative((*x)[0], 1) < 1e-14);
  CHECK(relative((*x)[1], {-1, 2}) < 1e-14);
  CHECK((*x)[2] == std::conj((*x)[1]));
  CHECK(relative((*x)[3], -100) < 1e-14);
}

TEST_CASE("roots spread over twelve decades keep their relative accuracy") {
  Eigen::VectorXd p = vector({1});
  for (int decade = -6; decade <= 6; ++decade) p = multiply(p, vector({1, std::pow(10.0, decade)}));
  const auto x = roots(p);
  REQUIRE(x);
  REQUIRE(x->size() == 13);
  for (Eigen::Index k = 0; k < 13; ++k) CHECK(relative((*x)[k], -std::pow(10.0, static_cast<double>(k - 6))) < 1e-12);
}

TEST_CASE("roots at zero are exact and leading zeros do not count") {
  const auto x = roots(vector({0, 0, 2, 4, 0, 0}));
  REQUIRE(x);
  REQUIRE(x->size() == 3);
  CHECK((*x)[0] == 0.0);
  CHECK((*x)[1] == 0.0);
  CHECK((*x)[2] == -2.0);
  CHECK(roots(vector({7}))->size() == 0);
}

TEST_CASE("a root of multiplicity five is found as a cluster that multiplies out to the polynomial") {
  Eigen::VectorXd p = vector({1});
  for (int k = 0; k < 5; ++k) p = multiply(p, vector({1, 2}));
  const auto x = roots(p);
  REQUIRE(x);
  for (const Complex& root : *x) CHECK(std::abs(root + 2.0) < 0.01);
  const auto again = polynomial_from_roots(*x);
  REQUIRE(again);
  CHECK(((*again - p).array() / p.array()).abs().maxCoeff() < 1e-12);
}

TEST_CASE("polynomials without roots to give are refused by name") {
  CHECK(roots(vector({0, 0})).error().text == "the polynomial is zero: every number is a root");
  CHECK(roots(vector({1, std::numeric_limits<double>::quiet_NaN()})).error().text ==
        "a coefficient of the polynomial is not a finite number");
}

TEST_CASE("a complex root without its conjugate is refused with its value") {
  Eigen::VectorXcd x(3);
  x << Complex(-1, 2), Complex(-3, 0), Complex(-1, 2);
  CHECK(split_roots(x).error().text == "the root -1+2i stands without its conjugate -1-2i");
  x[2] = Complex(-1, -2.5);
  CHECK(split_roots(x).error().text == "the root -1+2i stands without its conjugate -1-2i");
  x[2] = Complex(-1, -2);
  REQUIRE(split_roots(x));
  CHECK(split_roots(x)->pairs == std::vector<Complex>{{-1, 2}});
  CHECK(split_roots(x)->real == std::vector<double>{-3});
}

TEST_CASE("balancing makes rows and columns alike, by powers of two, and keeps the matrix similar") {
  Eigen::MatrixXd m(3, 3);
  m << 1, 1e6, 0, 1e-6, 2, 3e5, 0, 4e-4, 5;
  const Eigen::VectorXd scales = balancing_scales(m);
  for (const double s : scales) CHECK(std::exp2(std::round(std::log2(s))) == s);
  const Eigen::MatrixXd balanced = scaled_by(m, scales);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double ratio =
        (balanced.row(i).cwiseAbs().sum() - balanced(i, i)) / (balanced.col(i).cwiseAbs().sum() - balanced(i, i));
    CHECK(ratio > 0.25);
    CHECK(ratio < 4.0);
  }
  CHECK(scaled_by(balanced, scales.cwiseInverse()) == m);
}
