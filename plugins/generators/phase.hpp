#pragma once

#include <bodeflow/rate.hpp>
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
  /// The sum of n steps.
  Phase times(std::uint64_t n) const { return Phase(fraction_ * n); }

  /// In cycles, in [-0.5, 0.5].
  double cycles() const;

 private:
  explicit Phase(Fraction128 fraction) : fraction_(fraction) {}
  Fraction128 fraction_ = 0;
};

/// sin(2 pi cycles) for |cycles| <= 0.5, off by less than 4e-16. From portable operations only: the same bits on every machine.
double sine_of_cycles(double cycles);

}  // namespace bodeflow::generators
