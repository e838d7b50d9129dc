// Loops that are compiled once for each vector level. This file includes nothing with inline functions: a copy of one compiled
// for a wide unit could end up being called on a processor without it.

#include <stddef.h>

namespace bodeflow::numerics {
namespace {

[[gnu::always_inline]] inline void multiply_all(const double* x, double gain, double* y, size_t count) {
#pragma GCC ivdep
  for (size_t n = 0; n < count; ++n) y[n] = gain * x[n];
}

#if defined(__x86_64__)
[[gnu::target("arch=x86-64-v4,prefer-vector-width=512")]] void multiply_v4(const double* x, double gain, double* y,
                                                                           size_t count) {
  multiply_all(x, gain, y, count);
}
[[gnu::target("arch=x86-64-v3")]] void multiply_v3(const double* x, double gain, double* y, size_t count) {
  multiply_all(x, gain, y, count);
}
#endif

}  // namespace

void multiply(const double* x, double gain, double* y, size_t count, int vector_level) {
#if defined(__x86_64__)
  if (vector_level >= 4) return multiply_v4(x, gain, y, count);
  if (vector_level >= 3) return multiply_v3(x, gain, y, count);
#endif
  multiply_all(x, gain, y, count);
}

}  // namespace bodeflow::numerics
