#include "digital_oscillator.hpp"

#include <cmath>

#include "phase.hpp"

namespace bodeflow::generators {

DigitalOscillator::DigitalOscillator(const OscillatorBits& bits)
    : bits_(bits.accumulator),
      dropped_(bits.accumulator - bits.table),
      mask_((std::uint64_t{1} << bits.accumulator) - 1),
      table_(std::size_t{1} << bits.table) {
  const double largest = std::ldexp(1.0, bits.amplitude - 1) - 1;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const double cycles = static_cast<double>(i) / static_cast<double>(table_.size());
    table_[i] = std::nearbyint(largest * sine_of_cycles(cycles > 0.5 ? cycles - 1 : cycles)) / largest;
  }
}

std::uint64_t DigitalOscillator::word_of(std::uint64_t step64) const {
  const std::uint64_t half = std::uint64_t{1} << (63 - bits_);
  return ((step64 + half) >> (64 - bits_)) & mask_;
}

double DigitalOscillator::next(numerics::Random& dither) {
  // Without dropped bits there is nothing to dither, and a shift by 64 would be undefined.
  const std::uint64_t added = dropped_ > 0 ? dither.bits() >> (64 - dropped_) : 0;
  return table_[((step() + added) & mask_) >> dropped_];
}

}  // namespace bodeflow::generators
