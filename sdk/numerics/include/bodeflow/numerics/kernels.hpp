#pragma once

#include <cstddef>

namespace bodeflow::numerics {

/// y[n] = gain x[n] for n < count, with the vector unit of `vector_level` (Activation::vector_level: 1 SSE2, 3 AVX2, 4 AVX-512);
/// the bits are the same at every level. x and y are the same memory or do not overlap.
void multiply(const double* x, double gain, double* y, std::size_t count, int vector_level);

}  // namespace bodeflow::numerics
