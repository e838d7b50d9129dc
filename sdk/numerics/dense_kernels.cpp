// Loops that are compiled once for each vector unit. This file includes nothing with inline functions: a copy of one compiled for
// a wide unit could end up being called on a processor without it. Every sum has one order at all of them, products and sums are
// rounded one by one: the bits are the same.

#include "dense_kernels.hpp"

#define BODEFLOW_INLINE [[gnu::always_inline]] inline

namespace bodeflow::numerics::kernels {
namespace {

BODEFLOW_INLINE size_t least(size_t a, size_t b) { return a < b ? a : b; }

/// A tile of C: MV vectors of W rows by N columns, from packed panels of A and B, added to `c` or, of a tile at the edge, to so
/// many of its rows and columns.
template <int W, int MV, int N>
struct Tile {
  static constexpr size_t kRows = W * MV, kColumns = N;
  using Vector [[gnu::vector_size(W * 8), gnu::aligned(8), gnu::may_alias]] = double;

  BODEFLOW_INLINE static void add(size_t terms, const double* a, const double* b, double* c, size_t stride, double factor,
                                  size_t rows, size_t columns) {
    Vector sum[MV][N] = {};
    for (size_t p = 0; p < terms; ++p) {
      Vector from[MV];
#pragma GCC unroll 8
      for (int i = 0; i < MV; ++i) from[i] = *reinterpret_cast<const Vector*>(a + p * kRows + static_cast<size_t>(i * W));
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j) {
        const double with = b[p * kColumns + static_cast<size_t>(j)];
#pragma GCC unroll 8
        for (int i = 0; i < MV; ++i) sum[i][j] += from[i] * with;
      }
    }
    if (rows == kRows && columns == kColumns) {
#pragma GCC unroll 8
      for (int j = 0; j < N; ++j)
#pragma GCC unroll 8
        for (int i = 0; i < MV; ++i) {
          double* const to = c + static_cast<size_t>(j) * stride + static_cast<size_t>(i * W);
          const Vector now = *reinterpret_cast<const Vector*>(to) + factor * sum[i][j];
          *reinterpret_cast<Vector*>(to) = now;
        }
      return;
    }
    double part[kRows * kColumns];
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j)
#pragma GCC unroll 8
      for (int i = 0; i < MV; ++i)
        *reinterpret_cast<Vector*>(part + static_cast<size_t>(j) * kRows + static_cast<size_t>(i * W)) = factor * sum[i][j];
    for (size_t j = 0; j < columns; ++j)
      for (size_t i = 0; i < rows; ++i) c[j * stride + i] += part[j * kRows + i];
  }
};

/// Panels of R rows: term after term the rows of a panel, filled up with zeros.
template <size_t R>
BODEFLOW_INLINE void pack_rows(const double* a, size_t stride, size_t rows, size_t terms, double* packed) {
  for (size_t i = 0; i < rows; i += R) {
    const size_t some = least(R, rows - i);
    for (size_t p = 0; p < terms; ++p, packed += R) {
      const double* from = a + p * stride + i;
      for (size_t r = 0; r < some; ++r) packed[r] = from[r];
      for (size_t r = some; r < R; ++r) packed[r] = 0.0;
    }
  }
}

/// The same of the transpose: panels of R columns.
template <size_t R>
BODEFLOW_INLINE void pack_columns(const double* a, size_t stride, size_t columns, size_t terms, double* packed) {
  for (size_t i = 0; i < columns; i += R, packed += R * terms) {
    const size_t some = least(R, columns - i);
    for (size_t r = 0; r < some; ++r) {
      const double* from = a + (i + r) * stride;
      for (size_t p = 0; p < terms; ++p) packed[p * R + r] = from[p];
    }
    for (size_t r = some; r < R; ++r)
      for (size_t p = 0; p < terms; ++p) packed[p * R + r] = 0.0;
  }
}

template <class T>
BODEFLOW_INLINE void add_tiles(const Product& x, double* workspace) {
  double* const rows_packed = workspace;
  double* const columns_packed = workspace + kPackedRows * kPiece;
  for (size_t p = 0; p < x.terms; p += kPiece) {
    const size_t terms = least(kPiece, x.terms - p);
    pack_columns<T::kColumns>(x.b + p, x.b_stride, x.columns, terms, columns_packed);
    for (size_t i = 0; i < x.rows; i += kPackedRows) {
      const size_t rows = least(kPackedRows, x.rows - i);
      if (x.transposed) {
        pack_columns<T::kRows>(x.a + i * x.a_stride + p, x.a_stride, rows, terms, rows_packed);
      } else {
        pack_rows<T::kRows>(x.a + p * x.a_stride + i, x.a_stride, rows, terms, rows_packed);
      }
      for (size_t j = 0; j < x.columns; j += T::kColumns) {
        const double* const b = columns_packed + j * terms;
        for (size_t r = 0; r < rows; r += T::kRows)
          T::add(terms, rows_packed + r * terms, b, x.c + j * x.c_stride + i + r, x.c_stride, x.factor, least(T::kRows, rows - r),
                 least(T::kColumns, x.columns - j));
      }
    }
  }
}

using Eight [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;

BODEFLOW_INLINE double total(const Eight& s) { return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])); }

BODEFLOW_INLINE void dot_all(const double* a, size_t stride, size_t rows, size_t columns, const double* x, double* y) {
  const size_t whole = rows / 8 * 8;
  size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    const double* const c = a + j * stride;
    Eight s[4] = {};
    for (size_t i = 0; i < whole; i += 8) {
      const Eight with = *reinterpret_cast<const Eight*>(x + i);
#pragma GCC unroll 4
      for (size_t l = 0; l < 4; ++l) s[l] += *reinterpret_cast<const Eight*>(c + l * stride + i) * with;
    }
    for (size_t l = 0; l < 4; ++l) {
      double sum = total(s[l]);
      for (size_t i = whole; i < rows; ++i) sum += c[l * stride + i] * x[i];
      y[j + l] = sum;
    }
  }
  for (; j < columns; ++j) {
    const double* const c = a + j * stride;
    Eight s = {};
    for (size_t i = 0; i < whole; i += 8) s += *reinterpret_cast<const Eight*>(c + i) * *reinterpret_cast<const Eight*>(x + i);
    double sum = total(s);
    for (size_t i = whole; i < rows; ++i) sum += c[i] * x[i];
    y[j] = sum;
  }
}

BODEFLOW_INLINE void subtract_all(const double* a, size_t stride, size_t rows, size_t columns, const double* y, double* x) {
  const size_t whole = rows / 8 * 8;
  size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    const double* const c = a + j * stride;
    for (size_t i = 0; i < whole; i += 8) {
      Eight now = *reinterpret_cast<const Eight*>(x + i);
#pragma GCC unroll 4
      for (size_t l = 0; l < 4; ++l) now -= *reinterpret_cast<const Eight*>(c + l * stride + i) * y[j + l];
      *reinterpret_cast<Eight*>(x + i) = now;
    }
    for (size_t i = whole; i < rows; ++i)
      for (size_t l = 0; l < 4; ++l) x[i] -= c[l * stride + i] * y[j + l];
  }
  for (; j < columns; ++j) {
    const double* const c = a + j * stride;
    for (size_t i = 0; i < whole; i += 8) *reinterpret_cast<Eight*>(x + i) -= *reinterpret_cast<const Eight*>(c + i) * y[j];
    for (size_t i = whole; i < rows; ++i) x[i] -= c[i] * y[j];
  }
}

BODEFLOW_INLINE void outer_all(const double* x, size_t rows, const double* y, size_t columns, double* a, size_t stride) {
  const size_t whole = rows / 8 * 8;
  size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    double* const c = a + j * stride;
    for (size_t i = 0; i < whole; i += 8) {
      const Eight with = *reinterpret_cast<const Eight*>(x + i);
#pragma GCC unroll 4
      for (size_t l = 0; l < 4; ++l) *reinterpret_cast<Eight*>(c + l * stride + i) -= with * y[j + l];
    }
    for (size_t l = 0; l < 4; ++l)
      for (size_t i = whole; i < rows; ++i) c[l * stride + i] -= x[i] * y[j + l];
  }
  for (; j < columns; ++j) {
    double* const c = a + j * stride;
    for (size_t i = 0; i < whole; i += 8) *reinterpret_cast<Eight*>(c + i) -= *reinterpret_cast<const Eight*>(x + i) * y[j];
    for (size_t i = whole; i < rows; ++i) c[i] -= x[i] * y[j];
  }
}

void product_v1(const Product& x, double* w) { add_tiles<Tile<2, 2, 4>>(x, w); }
void dot_v1(const double* a, size_t s, size_t m, size_t n, const double* x, double* y) { dot_all(a, s, m, n, x, y); }
void subtract_v1(const double* a, size_t s, size_t m, size_t n, const double* y, double* x) { subtract_all(a, s, m, n, y, x); }
void outer_v1(const double* x, size_t m, const double* y, size_t n, double* a, size_t s) { outer_all(x, m, y, n, a, s); }

#if defined(__x86_64__)
#define BODEFLOW_V3 [[gnu::target("arch=x86-64-v3")]]
#define BODEFLOW_V4 [[gnu::target("arch=x86-64-v4,prefer-vector-width=512")]]
BODEFLOW_V3 void product_v3(const Product& x, double* w) { add_tiles<Tile<4, 3, 4>>(x, w); }
BODEFLOW_V3 void dot_v3(const double* a, size_t s, size_t m, size_t n, const double* x, double* y) { dot_all(a, s, m, n, x, y); }
BODEFLOW_V3 void subtract_v3(const double* a, size_t s, size_t m, size_t n, const double* y, double* x) {
  subtract_all(a, s, m, n, y, x);
}
BODEFLOW_V3 void outer_v3(const double* x, size_t m, const double* y, size_t n, double* a, size_t s) {
  outer_all(x, m, y, n, a, s);
}
BODEFLOW_V4 void product_v4(const Product& x, double* w) { add_tiles<Tile<8, 3, 8>>(x, w); }
BODEFLOW_V4 void dot_v4(const double* a, size_t s, size_t m, size_t n, const double* x, double* y) { dot_all(a, s, m, n, x, y); }
BODEFLOW_V4 void subtract_v4(const double* a, size_t s, size_t m, size_t n, const double* y, double* x) {
  subtract_all(a, s, m, n, y, x);
}
BODEFLOW_V4 void outer_v4(const double* x, size_t m, const double* y, size_t n, double* a, size_t s) {
  outer_all(x, m, y, n, a, s);
}
#endif

}  // namespace

int widest_vector_level() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return 4;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 3;
#endif
  return 1;
}

size_t packed_size(size_t columns) {
  return kPiece * (kPackedRows + (columns + kMostTileColumns - 1) / kMostTileColumns * kMostTileColumns);
}

void add_product(const Product& product, double* workspace, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return product_v4(product, workspace);
  if (vector_level >= 3) return product_v3(product, workspace);
#endif
  (void)vector_level;
  product_v1(product, workspace);
}

void dot_columns(const double* a, size_t a_stride, size_t rows, size_t columns, const double* x, double* y, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return dot_v4(a, a_stride, rows, columns, x, y);
  if (vector_level >= 3) return dot_v3(a, a_stride, rows, columns, x, y);
#endif
  (void)vector_level;
  dot_v1(a, a_stride, rows, columns, x, y);
}

void subtract_columns(const double* a, size_t a_stride, size_t rows, size_t columns, const double* y, double* x,
                      int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return subtract_v4(a, a_stride, rows, columns, y, x);
  if (vector_level >= 3) return subtract_v3(a, a_stride, rows, columns, y, x);
#endif
  (void)vector_level;
  subtract_v1(a, a_stride, rows, columns, y, x);
}

void subtract_outer(const double* x, size_t rows, const double* y, size_t columns, double* a, size_t a_stride, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return outer_v4(x, rows, y, columns, a, a_stride);
  if (vector_level >= 3) return outer_v3(x, rows, y, columns, a, a_stride);
#endif
  (void)vector_level;
  outer_v1(x, rows, y, columns, a, a_stride);
}

}  // namespace bodeflow::numerics::kernels
