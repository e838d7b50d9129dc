#include <Eigen/Core>
#include <bodeflow/numerics/products.hpp>
#include <bodeflow/numerics/random.hpp>
#include <bodeflow/numerics/stacked_qr.hpp>
#include <new>
#include <vector>

#include "catch.hpp"
#include "dense_kernels.hpp"

using namespace bodeflow::numerics;

namespace {

Eigen::MatrixXd random_matrix(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd m(rows, columns);
  for (double& x : m.reshaped()) x = random.normal();
  return m;
}

/// Sizes on both sides of tiles and pieces: rows, columns, terms.
const std::vector<std::array<Eigen::Index, 3>> kSizes = {{1, 1, 1}, {23, 7, 5}, {25, 9, 256}, {193, 17, 257}, {50, 40, 600}};

std::size_t size(Eigen::Index n) { return static_cast<std::size_t>(n); }

}  // namespace

TEST_CASE("products: they are those of Eigen to rounding at sizes around the tiles") {
  Random random(1);
  for (const auto& [m, n, k] : kSizes) {
    const Eigen::MatrixXd A = random_matrix(random, m, k), B = random_matrix(random, k, n), C = random_matrix(random, m, n);
    Eigen::MatrixXd sum = C;
    add_product(sum, A, B, -0.5);
    CHECK((sum - (C - 0.5 * A * B)).norm() <= 1e-14 * A.norm() * B.norm());
    CHECK((transposed_product(A, C) - A.transpose() * C).norm() <= 1e-14 * A.norm() * C.norm());
    CHECK((transposed_times(A, C.col(0)) - A.transpose() * C.col(0)).norm() <= 1e-14 * A.norm() * C.norm());
    Eigen::VectorXd left = C.col(0);
    subtract_product(left, A, B.col(0));
    CHECK((left - (C.col(0) - A * B.col(0))).norm() <= 1e-14 * A.norm() * B.norm());
    Eigen::MatrixXd rest = C;
    subtract_outer(rest, C.col(0), B.row(0).transpose());
    CHECK((rest - (C - C.col(0) * B.row(0))).norm() <= 1e-14 * C.norm() * B.norm());
  }
}

TEST_CASE("products: parts of larger matrices are read and written in place") {
  Random random(2);
  const Eigen::MatrixXd A = random_matrix(random, 40, 30), B = random_matrix(random, 30, 20);
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(50, 25);
  add_product(C.block(3, 2, 30, 11), A.middleRows(4, 30), B.middleCols(5, 11));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(50, 25);
  expected.block(3, 2, 30, 11) = A.middleRows(4, 30) * B.middleCols(5, 11);
  CHECK((C - expected).cwiseAbs().maxCoeff() <= 1e-12);
}

TEST_CASE("products: the bits are the same with each vector unit of the processor") {
  Random random(3);
  for (const auto& [m, n, k] : kSizes) {
    const Eigen::MatrixXd A = random_matrix(random, m, k), B = random_matrix(random, k, n), C = random_matrix(random, m, n);
    Eigen::MatrixXd first, first_transposed;
    Eigen::VectorXd first_dots;
    for (const int level : {1, 3, 4}) {
      if (level > kernels::widest_vector_level()) continue;
      auto* const workspace = new (std::align_val_t(64)) double[kernels::packed_size(size(n))];
      Eigen::MatrixXd sum = C, transposed = Eigen::MatrixXd::Zero(k, n);
      kernels::add_product({size(m), size(n), size(k), A.data(), size(m), false, B.data(), size(k), sum.data(), size(m), 0.3},
                           workspace, level);
      kernels::add_product(
          {size(k), size(n), size(m), A.data(), size(m), true, C.data(), size(m), transposed.data(), size(k), 1.0}, workspace,
          level);
      ::operator delete[](workspace, std::align_val_t(64));
      Eigen::VectorXd dots(k), x = C.col(0);
      kernels::dot_columns(A.data(), size(m), size(m), size(k), x.data(), dots.data(), level);
      kernels::subtract_columns(A.data(), size(m), size(m), size(k), dots.data(), x.data(), level);
      kernels::subtract_outer(x.data(), size(m), B.col(0).data(), 1, sum.data(), size(m), level);
      if (level == 1) {
        first = sum;
        first_transposed = transposed;
        first_dots = dots;
      }
      CHECK(sum == first);
      CHECK(transposed == first_transposed);
      CHECK(dots == first_dots);
    }
  }
}

TEST_CASE("stacked QR: the triangle has the inner products of what was folded into it") {
  Random random(4);
  for (const auto& [rows, columns] : {std::pair<Eigen::Index, Eigen::Index>{3, 7}, {60, 24}, {90, 61}}) {
    const Eigen::MatrixXd first = random_matrix(random, rows, columns), second = random_matrix(random, rows, columns);
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(columns, columns);
    for (Eigen::MatrixXd part : {first, second}) fold_rows(triangle, part);
    CHECK(triangle.isUpperTriangular(0.0));
    const Eigen::MatrixXd gram = first.transpose() * first + second.transpose() * second;
    CHECK((triangle.transpose() * triangle - gram).norm() <= 1e-13 * gram.norm());
  }
}

TEST_CASE("stacked QR: rows are split into what the columns explain and what they leave") {
  Random random(5);
  const Eigen::MatrixXd columns = random_matrix(random, 80, 30), given = random_matrix(random, 80, 4);
  const StackedQr factor(Eigen::MatrixXd::Zero(30, 30), columns);
  Eigen::MatrixXd top = Eigen::MatrixXd::Zero(30, 4), left = given;
  factor.apply(top, left);
  CHECK((columns.transpose() * left).norm() <= 1e-11);
  const Eigen::MatrixXd coefficients = factor.triangle().triangularView<Eigen::Upper>().solve(top);
  CHECK((columns * coefficients + left - given).norm() <= 1e-11);
}

TEST_CASE("stacked QR: columns of zeros and of extreme size do no harm") {
  Eigen::MatrixXd rows(3, 3);
  rows << 3e-200, 0, 1, 4e-200, 0, 2, 0, 0, 3;
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(3, 3);
  fold_rows(triangle, rows);
  CHECK(triangle.allFinite());
  CHECK(std::abs(triangle(0, 0)) == Approx(5e-200));
  CHECK(triangle.col(1).isZero(0.0));
}
