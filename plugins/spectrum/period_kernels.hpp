#pragma once

#include <stddef.h>

/// The loops of AveragingDft, with the vector unit of `vector_level` (Activation::vector_level: 1 SSE2, 3 AVX2, 4 AVX-512).
/// Spectra are `lines` complex numbers as pairs of doubles. No two arguments may overlap.
namespace bodeflow::spectrum {

/// to[n] = from[n] for n < count; false where one of them is not finite.
bool copy_finite(const double* from, double* to, size_t count, int vector_level);

/// to[n] = from[n] - offset for n < count.
void copy_without(const double* from, double offset, double* to, size_t count, int vector_level);

/// Sums of the deviations from a first spectrum.
struct Sums {
  const double* first;
  double* sum;      ///< of x - first, complex
  double* squares;  ///< of |x - first|^2, real
};

/// x -= first, and x is added to the sums.
void add_deviation(double* x, const Sums& sums, size_t lines, int vector_level);

/// The same, and products += x conj(other), where `other` is a deviation already.
void add_deviation(double* x, const Sums& sums, const double* other, double* products, size_t lines, int vector_level);

/// products += x conj(other).
void add_products(const double* x, const double* other, double* products, size_t lines, int vector_level);

}  // namespace bodeflow::spectrum
