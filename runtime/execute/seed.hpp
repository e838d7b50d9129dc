#pragma once

#include <cstdint>
#include <string_view>

namespace bodeflow::execute {

/// The seed of a block: FNV-1a of its name mixed with the run's seed by SplitMix64 (G. Steele, D. Lea, C. Flood: Fast splittable
/// pseudorandom number generators, 2014). The same on every machine; another name or run seed gives an unrelated one.
constexpr std::uint64_t block_seed(std::uint64_t run_seed, std::string_view name) {
  const auto mix = [](std::uint64_t z) {
    z += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
  };
  std::uint64_t hash = UINT64_C(0xCBF29CE484222325);
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * UINT64_C(0x100000001B3);
  return mix(mix(run_seed) ^ hash);
}

}  // namespace bodeflow::execute
