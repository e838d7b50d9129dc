#pragma once

#include <array>
#include <cstdint>

/// Seeded random numbers with the same bits on every machine: integers, sums, products, quotients and square roots only.
namespace bodeflow::numerics {

/// xoshiro256++ 1.0 (Blackman & Vigna, "Scrambled linear pseudorandom number generators", ACM Trans. Math. Softw. 47, 2021), its
/// state filled from the seed by splitmix64. Period 2^256 - 1.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /// The generator of stream `index` of a seed: streams of one seed are as independent as different seeds are.
  static Random stream(std::uint64_t seed, std::uint64_t index);

  /// 64 random bits.
  std::uint64_t bits();
  /// A number uniform on the open interval (0, 1): odd multiples of 2^-53. One call of `bits`.
  double uniform();
  /// A standard normal deviate: the quantile function at `uniform()`, so one call of `bits`, and |deviate| < 8.3.
  double normal();

 private:
  std::array<std::uint64_t, 4> state_;
};

/// The standard normal quantile of p in (0, 1). Relative accuracy about 1e-15.
/// Source: Wichura, "Algorithm AS 241: The percentage points of the normal distribution", Applied Statistics 37, 1988 (PPND16).
double normal_quantile(double p);

/// The natural logarithm of x > 0, normal and finite, within 2 units in the last place, from portable operations only.
double portable_log(double x);

}  // namespace bodeflow::numerics
