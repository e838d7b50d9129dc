#include "range.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <bodeflow/numerics/products.hpp>
#include <string>

#include "row_triangle.hpp"
#include "sanathanan_koerner/stacked.hpp"

namespace bodeflow::subspace {
namespace {

using sanathanan_koerner::multiplied;

constexpr Eigen::Index kBlock = 1000;   // lines that are worked through at once
constexpr double kOrthonormal = 1e-11;  // up to it, projections take the functions for orthonormal

/// Columns q_j G for one input: function j and output o in column j outputs + o.
Eigen::MatrixXd products(const Eigen::MatrixXd& values, const Lines& lines, Eigen::Index input, Eigen::Index first,
                         Eigen::Index size) {
  const Eigen::Index p = lines.outputs;
  Eigen::MatrixXd Y(2 * size, values.cols() * p);
  for (Eigen::Index o = 0; o < p; ++o)
    Y(Eigen::all, Eigen::seqN(o, values.cols(), p)) = multiplied(lines.response.col(input * p + o).segment(first, size), values);
  return Y;
}

Range decomposed(const Rule& rule, const Eigen::MatrixXd& R) {
  // R22 of the paper is the transpose of R.
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(R, Eigen::ComputeThinV);
  return {rule, svd.singularValues(), svd.matrixV()};
}

Expected<Range> short_range(const Lines& lines, const Plane& plane, Eigen::Index functions, Basis basis) {
  const auto f = functions_of(lines, plane, functions, basis);
  if (!f) return unexpected(f.error().text);
  const Eigen::MatrixXd& V = f->orthonormal.size() != 0 ? f->orthonormal : f->values;
  RowTriangle triangle(functions * lines.outputs);
  for (Eigen::Index input = 0; input < lines.inputs(); ++input) {
    Eigen::MatrixXd Y = products(f->values, lines, input, 0, lines.size());
    for (int pass = 0; pass < 2; ++pass) numerics::add_product(Y, V, numerics::transposed_product(V, Y), -1.0);
    triangle.add(std::move(Y));
  }
  return decomposed(f->rule, triangle.R());
}

/// Orthonormal functions: what they explain is subtracted in a second pass.
void add_projected(const Lines& lines, const LongFunctions& f, Eigen::Index input, RowTriangle& triangle) {
  const Eigen::Index functions = f.rule().shift.rows();
  Eigen::MatrixXd explained = Eigen::MatrixXd::Zero(functions, functions * lines.outputs);
  for (Eigen::Index k = 0; k < lines.size(); k += kBlock) {
    const Eigen::Index size = std::min(kBlock, lines.size() - k);
    const Eigen::MatrixXd V = f.block(k, size);
    explained += numerics::transposed_product(V, products(V, lines, input, k, size));
  }
  for (Eigen::Index k = 0; k < lines.size(); k += kBlock) {
    const Eigen::Index size = std::min(kBlock, lines.size() - k);
    const Eigen::MatrixXd V = f.block(k, size);
    Eigen::MatrixXd Y = products(V, lines, input, k, size);
    numerics::add_product(Y, V, explained, -1.0);
    triangle.add(std::move(Y));
  }
}

/// Functions that have lost orthogonality: factorisation of both together.
void add_factored(const Lines& lines, const LongFunctions& f, Eigen::Index input, RowTriangle& triangle) {
  const Eigen::Index functions = f.rule().shift.rows(), columns = functions * lines.outputs;
  RowTriangle both(functions + columns);
  for (Eigen::Index k = 0; k < lines.size(); k += kBlock) {
    const Eigen::Index size = std::min(kBlock, lines.size() - k);
    Eigen::MatrixXd rows(2 * size, functions + columns);
    rows.leftCols(functions) = f.block(k, size);
    rows.rightCols(columns) = products(rows.leftCols(functions), lines, input, k, size);
    both.add(std::move(rows));
  }
  triangle.add(both.R().bottomRightCorner(both.R().rows() - functions, columns));
}

Expected<Range> long_range(const Lines& lines, const Plane& plane, Eigen::Index functions) {
  const auto f = LongFunctions::make(lines, plane, functions);
  if (!f) return unexpected(f.error().text);
  const bool orthonormal = f->defect(kBlock) < kOrthonormal;
  RowTriangle triangle(functions * lines.outputs);
  for (Eigen::Index input = 0; input < lines.inputs(); ++input)
    orthonormal ? add_projected(lines, *f, input, triangle) : add_factored(lines, *f, input, triangle);
  return decomposed(f->rule(), triangle.R());
}

}  // namespace

Expected<Range> range_of(const Lines& lines, const Plane& plane, Eigen::Index functions, Basis basis, Eigen::Index long_data) {
  if (auto fine = check(lines, plane); !fine) return unexpected(fine.error().text);
  const Eigen::Index most = most_functions(lines);
  if (functions < 2 || functions > most)
    return unexpected(std::to_string(functions) + " basis functions; allowed for " + std::to_string(lines.size()) +
                      " lines: 2 to " + std::to_string(most));
  if (basis == Basis::arnoldi && 2 * lines.size() * functions > long_data) return long_range(lines, plane, functions);
  return short_range(lines, plane, functions, basis);
}

}  // namespace bodeflow::subspace
