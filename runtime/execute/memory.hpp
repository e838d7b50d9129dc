#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "plan/plan.hpp"

namespace bodeflow::execute {

/// The samples of one plan::Buffer: slot after slot, channel after channel, each channel padded to 64 bytes. A channel holds
/// `history` kept samples and then the new ones of a chunk.
struct BufferView {
  std::byte* base = nullptr;
  std::uint64_t element_bytes = 8;
  std::uint32_t channels = 1;
  std::uint64_t history = 0, capacity = 0;
  std::uint32_t slots = 1;
  std::uint64_t stride = 0;  ///< bytes from channel to channel

  std::byte* at(std::uint32_t slot, std::uint32_t channel, std::uint64_t sample) const {
    return base + (std::uint64_t{slot} * channels + channel) * stride + sample * element_bytes;
  }
  std::uint32_t slot(std::int64_t chunk) const { return slots == 1 ? 0 : static_cast<std::uint32_t>(chunk % slots); }
  std::uint64_t bytes() const { return std::uint64_t{slots} * channels * stride; }

  /// Copies `count` samples of every channel; the two places may overlap.
  void copy(std::uint32_t from_slot, std::uint64_t from, const BufferView& to, std::uint32_t to_slot, std::uint64_t place,
            std::uint64_t count) const;
};

/// The memory of a plan: one zeroed, 64-byte aligned arena a partition, with initial values in the histories.
class Memory {
 public:
  /// Error: a buffer that does not lie in its arena, or no memory.
  static tl::expected<Memory, std::string> make(const plan::Plan& plan);

  const BufferView& operator[](int buffer) const { return views_[static_cast<std::size_t>(buffer)]; }
  /// One more buffer without history, for an output that the plan gives none.
  int add_scratch(std::uint32_t element, std::uint32_t channels, std::uint64_t capacity);

 private:
  struct Free {
    void operator()(std::byte* bytes) const;
  };
  using Arena = std::unique_ptr<std::byte[], Free>;
  static Arena allocate(std::uint64_t bytes);

  std::vector<Arena> arenas_;
  std::vector<BufferView> views_;
};

}  // namespace bodeflow::execute
