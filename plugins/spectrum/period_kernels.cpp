// Loops that are compiled once for each vector level. This file includes nothing with inline functions: a copy of one compiled
// for a wide unit could end up being called on a processor without it.

#include "period_kernels.hpp"

#define BODEFLOW_INLINE [[gnu::always_inline]] inline

namespace bodeflow::spectrum {
namespace {

// 0 x is 0 unless x is not finite. Eight sums apart, for units of any width.
BODEFLOW_INLINE bool copy_finite_all(const double* __restrict from, double* __restrict to, size_t count) {
  double zeros[8] = {};
  size_t n = 0;
  for (; n + 8 <= count; n += 8) {
    for (size_t i = 0; i < 8; ++i) {
      to[n + i] = from[n + i];
      zeros[i] += from[n + i] * 0.0;
    }
  }
  for (; n < count; ++n) {
    to[n] = from[n];
    zeros[0] += from[n] * 0.0;
  }
  for (size_t i = 1; i < 8; ++i) zeros[0] += zeros[i];
  return zeros[0] == 0.0;
}

BODEFLOW_INLINE void copy_without_all(const double* __restrict from, double offset, double* __restrict to, size_t count) {
  for (size_t n = 0; n < count; ++n) to[n] = from[n] - offset;
}

BODEFLOW_INLINE void add_deviation_all(double* __restrict x, const double* __restrict first, double* __restrict sum,
                                       double* __restrict squares, size_t lines) {
  for (size_t k = 0; k < lines; ++k) {
    const double re = x[2 * k] - first[2 * k], im = x[2 * k + 1] - first[2 * k + 1];
    x[2 * k] = re;
    x[2 * k + 1] = im;
    sum[2 * k] += re;
    sum[2 * k + 1] += im;
    squares[k] += re * re + im * im;
  }
}

BODEFLOW_INLINE void add_deviation_all(double* __restrict x, const double* __restrict first, double* __restrict sum,
                                       double* __restrict squares, const double* __restrict other, double* __restrict products,
                                       size_t lines) {
  for (size_t k = 0; k < lines; ++k) {
    const double re = x[2 * k] - first[2 * k], im = x[2 * k + 1] - first[2 * k + 1];
    x[2 * k] = re;
    x[2 * k + 1] = im;
    sum[2 * k] += re;
    sum[2 * k + 1] += im;
    squares[k] += re * re + im * im;
    products[2 * k] += re * other[2 * k] + im * other[2 * k + 1];
    products[2 * k + 1] += im * other[2 * k] - re * other[2 * k + 1];
  }
}

BODEFLOW_INLINE void add_products_all(const double* __restrict x, const double* __restrict other, double* __restrict products,
                                      size_t lines) {
  for (size_t k = 0; k < lines; ++k) {
    products[2 * k] += x[2 * k] * other[2 * k] + x[2 * k + 1] * other[2 * k + 1];
    products[2 * k + 1] += x[2 * k + 1] * other[2 * k] - x[2 * k] * other[2 * k + 1];
  }
}

}  // namespace

// One function a loop and level, and the choice between them. AVX2 without FMA: GCC 12 joins the products of complex numbers in
// one rounding where it can, contraction switched off or not, and the bits would differ from level to level. AVX-512 has FMA
// always.
#if defined(__x86_64__)
#define BODEFLOW_LEVELS(type, name, loop, parameters, arguments)               \
  namespace {                                                                  \
  [[gnu::target("avx2")]] type name##_v3 parameters { return loop arguments; } \
  type name##_v1 parameters { return loop arguments; }                         \
  }                                                                            \
  static constexpr type(*name##_of[]) parameters = {name##_v1, name##_v3};
#else
#define BODEFLOW_LEVELS(type, name, loop, parameters, arguments) \
  namespace {                                                    \
  type name##_v1 parameters { return loop arguments; }           \
  }                                                              \
  static constexpr type(*name##_of[]) parameters = {name##_v1, name##_v1};
#endif

BODEFLOW_LEVELS(bool, finite, copy_finite_all, (const double* from, double* to, size_t count), (from, to, count))
BODEFLOW_LEVELS(void, without, copy_without_all, (const double* from, double offset, double* to, size_t count),
                (from, offset, to, count))
BODEFLOW_LEVELS(void, deviation, add_deviation_all, (double* x, const Sums& s, size_t lines),
                (x, s.first, s.sum, s.squares, lines))
BODEFLOW_LEVELS(void, deviation_and_products, add_deviation_all,
                (double* x, const Sums& s, const double* other, double* products, size_t lines),
                (x, s.first, s.sum, s.squares, other, products, lines))
BODEFLOW_LEVELS(void, only_products, add_products_all, (const double* x, const double* other, double* products, size_t lines),
                (x, other, products, lines))

static int place(int vector_level) { return vector_level >= 3 ? 1 : 0; }

bool copy_finite(const double* from, double* to, size_t count, int vector_level) {
  return finite_of[place(vector_level)](from, to, count);
}

void copy_without(const double* from, double offset, double* to, size_t count, int vector_level) {
  without_of[place(vector_level)](from, offset, to, count);
}

void add_deviation(double* x, const Sums& sums, size_t lines, int vector_level) {
  deviation_of[place(vector_level)](x, sums, lines);
}

void add_deviation(double* x, const Sums& sums, const double* other, double* products, size_t lines, int vector_level) {
  deviation_and_products_of[place(vector_level)](x, sums, other, products, lines);
}

void add_products(const double* x, const double* other, double* products, size_t lines, int vector_level) {
  only_products_of[place(vector_level)](x, other, products, lines);
}

}  // namespace bodeflow::spectrum
