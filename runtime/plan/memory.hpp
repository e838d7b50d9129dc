#pragma once

#include <cstdint>
#include <vector>

#include "plan/buffers.hpp"

namespace bodeflow::plan {

/// Memory that is needed from step `first` to step `last` of a list, both included.
struct Lifetime {
  std::uint64_t bytes = 0;  ///< a multiple of 64
  int first = 0, last = 0;
};

struct Layout {
  std::vector<std::uint64_t> offsets;  ///< of each lifetime
  std::uint64_t bytes = 0;             ///< of all together
};

/// Offsets such that no two lifetimes overlap both in steps and in bytes: the largest first, each as low as it goes.
Layout lay_out(const std::vector<Lifetime>& lifetimes);

/// Sets the partition, slots, bytes and offset of every buffer, the readers across partitions and the sizes of the arenas.
/// `kept` outputs live to the end of the chunk; histories and rings always.
void place_buffers(const graph::Phase& phase, Buffers& buffers, const std::vector<graph::End>& kept, Plan& plan);

}  // namespace bodeflow::plan
