#include "signal.hpp"

#include <limits>

namespace bodeflow::testing {
namespace {

/// A hash of 64 bits: splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

}  // namespace

double ordinary_sample(std::size_t input, std::size_t channel, std::uint64_t n) {
  const std::uint64_t bits = mixed(mixed(mixed(n) ^ (channel + 1)) ^ (input + 101));
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
}

double bad_sample(std::size_t input, std::size_t channel, std::uint64_t n) {
  using limits = std::numeric_limits<double>;
  switch (mixed(n + channel + input) % 9) {
    case 0:
      return limits::quiet_NaN();
    case 1:
      return limits::infinity();
    case 2:
      return -limits::infinity();
    case 3:
      return limits::denorm_min();
    case 4:
      return limits::max();
    case 5:
      return -limits::max();
    case 6:
      return -0.0;
    case 7:
      return limits::min();
    default:
      return ordinary_sample(input, channel, n);
  }
}

}  // namespace bodeflow::testing
