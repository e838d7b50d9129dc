#include "phase.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::generators {

Phase Phase::from_radians(double radians) {
  const double cycles = radians / (2 * std::numbers::pi);
  const double fraction = cycles - std::floor(cycles);
  // 2^64 itself, from a tiny negative phase, is a whole cycle and falls off.
  return Phase(static_cast<Fraction128>(std::ldexp(fraction, 64)) << 64);
}

Phase Phase::step(double frequency_hz, Rate rate) {
  int exponent = 0;
  const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(frequency_hz, &exponent), 53));
  exponent -= 53;
  // frequency / rate = mantissa * den * 2^exponent / num: a long division for 128 binary places.
  const Fraction128 above = static_cast<Fraction128>(mantissa) * static_cast<std::uint64_t>(rate.den);
  const auto below = static_cast<std::uint64_t>(rate.num);
  Fraction128 quotient = above / below;
  auto rest = static_cast<std::uint64_t>(above % below);
  const int places = 128 + exponent;
  if (places < 0) return Phase(-places < 128 ? quotient >> -places : 0);
  for (int place = 0; place < places; ++place) {
    const bool one = rest >= below - rest;
    rest = one ? rest - (below - rest) : rest + rest;
    quotient = 2 * quotient + (one ? 1 : 0);
  }
  return Phase(quotient + (rest >= below - rest ? 1 : 0));
}

double Phase::cycles() const {
  // Read as a signed number: the fraction nearest to zero.
  return static_cast<double>(static_cast<std::int64_t>(fraction64())) * 0x1.0p-64;
}

}  // namespace bodeflow::generators
