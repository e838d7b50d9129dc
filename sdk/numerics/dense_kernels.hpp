#pragma once

#include <stddef.h>

namespace bodeflow::numerics::kernels {

/// Rows of A that a tile takes at most, and columns of B: what is packed is filled up to a multiple of them.
constexpr size_t kMostTileRows = 24, kMostTileColumns = 8;
/// A product is summed in pieces of that many terms, whatever the vector unit: each piece from zero, then added.
constexpr size_t kPiece = 256;
/// Rows of A that are packed at a time: a multiple of each tile's rows.
constexpr size_t kPackedRows = 192;

/// The widest vector unit that the loops here are compiled for and the processor has: 1 SSE2, 3 AVX2, 4 AVX-512. The bits of
/// their results are the same with each.
int widest_vector_level();

/// C += factor * op(A) B. C is rows x columns, B is terms x columns, A is rows x terms, or its transpose; all by columns with the
/// strides given. workspace: packed_size(columns) numbers, aligned to 64 bytes.
struct Product {
  size_t rows, columns, terms;
  const double* a;
  size_t a_stride;
  bool transposed;
  const double* b;
  size_t b_stride;
  double* c;
  size_t c_stride;
  double factor;
};
size_t packed_size(size_t columns);
void add_product(const Product& product, double* workspace, int vector_level);

/// y_j = sum over the rows of a(row, j) x(row), for each column of A, in eight partial sums.
void dot_columns(const double* a, size_t a_stride, size_t rows, size_t columns, const double* x, double* y, int vector_level);

/// x -= A y, column after column.
void subtract_columns(const double* a, size_t a_stride, size_t rows, size_t columns, const double* y, double* x,
                      int vector_level);

/// A -= x y'.
void subtract_outer(const double* x, size_t rows, const double* y, size_t columns, double* a, size_t a_stride, int vector_level);

}  // namespace bodeflow::numerics::kernels
