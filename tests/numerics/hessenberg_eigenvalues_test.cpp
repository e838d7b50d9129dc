#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/hessenberg_eigenvalues.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <limits>

#include "catch.hpp"

using namespace bodeflow::numerics;

namespace {

double worst_match(const Eigen::VectorXcd& found, const Eigen::VectorXcd& expected) {
  double worst = 0.0;
  for (const std::complex<double> p : expected) worst = std::max(worst, (found.array() - p).abs().minCoeff());
  return worst;
}

}  // namespace

TEST_CASE("eigenvalues: of random matrices they are those of the Schur form") {
  Random random(6);
  for (const Eigen::Index n : {1, 2, 3, 4, 7, 20, 60}) {
    Eigen::MatrixXd A(n, n);
    for (double& x : A.reshaped()) x = random.normal();
    const auto found = eigenvalues(A);
    REQUIRE(found);
    REQUIRE(found->size() == n);
    const Eigen::VectorXcd expected = A.eigenvalues();
    CHECK(worst_match(*found, expected) < 1e-11);
    CHECK(worst_match(expected, *found) < 1e-11);
    CHECK(std::abs(found->sum() - A.trace()) < 1e-11);
  }
}

TEST_CASE("eigenvalues: conjugates stand side by side, the one above the axis first") {
  Random random(7);
  Eigen::MatrixXd A(15, 15);
  for (double& x : A.reshaped()) x = random.normal();
  const auto found = eigenvalues(A);
  REQUIRE(found);
  for (Eigen::Index i = 0; i < 15; ++i) {
    if ((*found)[i].imag() == 0.0) continue;
    CHECK((*found)[i].imag() > 0.0);
    CHECK((*found)[i + 1] == std::conj((*found)[i]));
    ++i;
  }
}

TEST_CASE("eigenvalues: a cyclic shift needs the odd step and gives the roots of one") {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(8, 8);
  A.diagonal(-1).setOnes();
  A(0, 7) = 1.0;
  const auto found = hessenberg_eigenvalues(A);
  REQUIRE(found);
  CHECK((found->array().pow(8) - 1.0).abs().maxCoeff() < 1e-12);
}

TEST_CASE("eigenvalues: zeros and defects are no obstacle") {
  const auto none = hessenberg_eigenvalues(Eigen::MatrixXd::Zero(5, 5));
  REQUIRE(none);
  CHECK(none->isZero(0.0));
  Eigen::MatrixXd jordan = 2.0 * Eigen::MatrixXd::Identity(4, 4);
  jordan.diagonal(1).setOnes();
  const auto same = hessenberg_eigenvalues(jordan);
  REQUIRE(same);
  CHECK((same->array() - 2.0).abs().maxCoeff() < 1e-12);
  CHECK(hessenberg_eigenvalues(Eigen::MatrixXd(0, 0))->size() == 0);
}

TEST_CASE("eigenvalues: matrices that are not finite are refused") {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(3, 3);
  A(1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(eigenvalues(A).error().text == "the matrix is not finite");
}
