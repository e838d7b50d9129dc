#include "orthogonal.hpp"

#include <bit>

#include "phase.hpp"

namespace bodeflow::generators {

bool has_signs_only(std::size_t size) { return std::has_single_bit(size); }

std::complex<double> orthogonal_entry(std::size_t experiment, std::size_t channel, std::size_t size) {
  if (has_signs_only(size)) return std::popcount(experiment & channel) % 2 == 0 ? 1.0 : -1.0;
  const double turns = static_cast<double>(experiment * channel % size) / static_cast<double>(size);
  return turn_of_cycles(turns > 0.5 ? turns - 1 : turns);
}

}  // namespace bodeflow::generators
