#pragma once

#include <bodeflow/rate.hpp>
#include <complex>
#include <cstdint>

namespace bodeflow::generators {

__extension__ using Fraction128 = unsigned __int128;

/// A phase as a 128-bit fraction of a cycle. Whole cycles fall off by themselves, and adding is exact, so that the phase after n
/// steps is off by at most n * 2^-129 cycles: below the rounding of a double for any run.
class Phase {
 public:
  Phase() = default;
  /// From radians; good to 2^-53 cycles for |radians| < 2 pi.
  static Phase from_radians(double radians);
  /// The step between samples: frequency_hz / rate cycles, correctly rounded to 2^-128. frequency_hz is finite and at least 0.
  static Phase step(double frequency_hz, Rate rate);

  Phase& operator+=(Phase other) { return fraction_ += other.fraction_, *this; }
  Phase& operator-=(Phase other) { return fraction_ -= other.fraction_, *this; }
  /// The sum of n steps.
  Phase times(std::uint64_t n) const { return Phase(fraction_ * n); }

  /// An n-th of the fraction of a cycle, rounded down; n >= 1.
  Phase divided(std::uint64_t n) const { return Phase(fraction_ / n); }
  /// The fraction of a cycle in units of 2^-64, rounded to nearest: just below a whole cycle it is 0.
  std::uint64_t fraction64() const {
    return static_cast<std::uint64_t>(fraction_ >> 64) + (static_cast<std::uint64_t>(fraction_ >> 63) & 1u);
  }

  /// In cycles, in [-0.5, 0.5].
  double cycles() const;

 private:
  explicit Phase(Fraction128 fraction) : fraction_(fraction) {}
  Fraction128 fraction_ = 0;
};

/// sin(2 pi cycles) for |cycles| <= 0.5, off by less than 4e-16. From portable operations only: the same bits on every machine.
/// Method: Taylor series on a quarter of a turn; without branches, so that loops over it run on vectors.
inline double sine_of_cycles(double cycles) {
  // (2 pi)^(2k+1) / (2k+1)! with alternating signs. At |x| = 1/4 the first term left out is below 2e-18.
  constexpr double kSeries[] = {6.2831853071795864769,    -41.341702240399760234,  81.605249276075054203,
                                -76.705859753061385842,   42.058693944897653145,   -15.094642576822990391,
                                3.8199525848482821277,    -0.71812230177850051223, 0.10422916220813983517,
                                -0.012031585942120627233, 0.0011309237482517961878};
  // Into [-1/4, 1/4]: the differences are exact.
  double x = cycles;
  x = x > 0.25 ? 0.5 - x : x;
  x = x < -0.25 ? -0.5 - x : x;
  const double square = x * x;
  double sum = kSeries[10];
  for (int k = 10; k-- > 0;) sum = sum * square + kSeries[k];
  return x * sum;
}

/// exp(2 pi i cycles) for |cycles| <= 0.5, each part as good as `sine_of_cycles`.
inline std::complex<double> turn_of_cycles(double cycles) {
  return {sine_of_cycles(cycles > 0.25 ? cycles - 0.75 : cycles + 0.25), sine_of_cycles(cycles)};
}

}  // namespace bodeflow::generators
