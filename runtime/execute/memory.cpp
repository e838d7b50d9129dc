#include "execute/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bodeflow/record_layout.hpp>
#include <cstdlib>
#include <cstring>
#include <new>

namespace bodeflow::execute {
namespace {

constexpr std::uint64_t kAlignment = 64;

BufferView view_of(std::uint32_t element, std::uint32_t channels, std::uint64_t history, std::uint64_t capacity,
                   std::uint32_t slots) {
  BufferView view;
  view.element_bytes = element_size(element);
  view.channels = channels;
  view.history = history;
  view.capacity = capacity;
  view.slots = std::max(slots, 1u);
  view.stride = align_up((history + capacity) * view.element_bytes, kAlignment);
  return view;
}

void write_initial(const BufferView& view, const std::vector<double>& values) {
  const std::uint64_t bytes = view.history * view.element_bytes;
  for (std::uint32_t c = 0; c < view.channels; ++c)
    std::memcpy(view.at(0, c, 0), reinterpret_cast<const std::byte*>(values.data()) + c * bytes, bytes);
}

}  // namespace

void BufferView::copy(std::uint32_t from_slot, std::uint64_t from, const BufferView& to, std::uint32_t to_slot,
                      std::uint64_t place, std::uint64_t count) const {
  for (std::uint32_t c = 0; c < channels; ++c)
    std::memmove(to.at(to_slot, c, place), at(from_slot, c, from), count * element_bytes);
}

void Memory::Free::operator()(std::byte* bytes) const { std::free(bytes); }

Memory::Arena Memory::allocate(std::uint64_t bytes) {
  const std::uint64_t whole = align_up(std::max<std::uint64_t>(bytes, kAlignment), kAlignment);
  auto* memory = static_cast<std::byte*>(std::aligned_alloc(kAlignment, whole));
  if (memory == nullptr) throw std::bad_alloc();
  std::memset(memory, 0, whole);
  return Arena(memory);
}

tl::expected<Memory, std::string> Memory::make(const plan::Plan& plan) {
  Memory memory;
  for (const auto& partition : plan.partitions) memory.arenas_.push_back(allocate(partition.arena_bytes));
  for (std::size_t i = 0; i < plan.buffers.size(); ++i) {
    const plan::Buffer& buffer = plan.buffers[i];
    BufferView view = view_of(buffer.element, buffer.channels, buffer.history, buffer.capacity, buffer.slots);
    const auto partition = static_cast<std::size_t>(buffer.partition);
    if (partition >= plan.partitions.size() || buffer.arena_offset % kAlignment != 0 ||
        buffer.arena_offset + view.bytes() > plan.partitions[partition].arena_bytes)
      return tl::unexpected(fmt::format("plan: buffer {} ({} bytes at {}) does not fit into the arena of partition {}", i,
                                        view.bytes(), buffer.arena_offset, buffer.partition));
    view.base = memory.arenas_[partition].get() + buffer.arena_offset;
    if (i < plan.initial.size() && !plan.initial[i].empty()) {
      if (plan.initial[i].size() * sizeof(double) != view.channels * view.history * view.element_bytes)
        return tl::unexpected(fmt::format("plan: buffer {} has {} initial values for {} channels of {} samples", i,
                                          plan.initial[i].size(), view.channels, view.history));
      write_initial(view, plan.initial[i]);
    }
    memory.views_.push_back(view);
  }
  return memory;
}

int Memory::add_scratch(std::uint32_t element, std::uint32_t channels, std::uint64_t capacity) {
  BufferView view = view_of(element, channels, 0, capacity, 1);
  arenas_.push_back(allocate(view.bytes()));
  view.base = arenas_.back().get();
  views_.push_back(view);
  return static_cast<int>(views_.size()) - 1;
}

}  // namespace bodeflow::execute
