#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

namespace bodeflow::generators {

/// Sums x[n] = sum_k X[k] exp(2 pi i k n / N), n = 0 .. N-1, for one N >= 1.
///
/// Method: decimation in k by factors of N (4 first, then the smallest), the factors exp(2 pi i m / N) each good to rounding. Own
/// code in place of a library, so that the bits of an excitation are the same on every machine. Cost: O(N sum of the factors of
/// N).
class FourierSum {
 public:
  using Complex = std::complex<double>;

  explicit FourierSum(std::size_t size);

  /// Both have N values and do not overlap.
  void run(std::span<const Complex> lines, std::span<Complex> x);

  /// About the number of operations for N, in units of N: the sum of its factors.
  static std::int64_t sum_of_factors(std::int64_t size);

 private:
  void sum(const Complex* lines, std::size_t stride, Complex* x, std::size_t count);
  void join_four(Complex* x, std::size_t part, std::size_t stride) const;
  void join(Complex* x, std::size_t part, std::size_t radix, std::size_t stride);

  std::vector<Complex> turns_;  // exp(2 pi i m / N)
  std::vector<Complex> group_;
};

}  // namespace bodeflow::generators
