#pragma once

#include "plan/links.hpp"

namespace bodeflow::plan {

/// A buffer that gets a copy of what a block writes.
struct Copy {
  int block = 0;  ///< the writer
  int port = 0;
  int from = 0, to = 0;
  std::vector<int> readers;  ///< blocks
};

/// The memory of all streams: which port uses what. Offsets, slots and partitions come later.
struct Buffers {
  std::vector<Buffer> all;
  std::vector<std::vector<double>> initial;
  std::vector<std::vector<Use>> inputs, outputs;  ///< per block
  std::vector<int> writer;                        ///< per buffer: the block
  std::vector<std::vector<int>> readers;          ///< per buffer: blocks, ascending, without repeats
  std::vector<Copy> copies;                       ///< for readers whose initial values differ from those of the others
};

/// One buffer a stream output for chunks of `repetitions` periods. Delayed readers share it as long as their initial values
/// agree: each sees the newest `delay` samples of the history first.
Buffers assign_buffers(const graph::Phase& phase, const Facts& facts, std::int64_t repetitions);

/// Bytes of one slot: each channel padded to 64 bytes.
std::uint64_t slot_bytes(const Buffer& buffer);

}  // namespace bodeflow::plan
