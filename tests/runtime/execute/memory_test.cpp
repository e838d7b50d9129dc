#include "execute/memory.hpp"

#include "catch.hpp"

namespace bodeflow::execute {
namespace {

plan::Plan one_buffer(plan::Buffer buffer, std::uint64_t arena_bytes) {
  plan::Plan plan;
  plan.partitions.resize(1);
  plan.partitions[0].arena_bytes = arena_bytes;
  plan.buffers.push_back(buffer);
  plan.initial.emplace_back();
  return plan;
}

TEST_CASE("memory: channels begin at multiples of 64 bytes and initial values stand before the first sample") {
  plan::Buffer buffer;
  buffer.channels = 2;
  buffer.history = 3;
  buffer.capacity = 6;
  plan::Plan plan = one_buffer(buffer, 256);
  plan.initial[0] = {1, 2, 3, 4, 5, 6};
  const auto memory = Memory::make(plan);
  REQUIRE(memory);
  const BufferView& view = (*memory)[0];
  for (std::uint32_t c = 0; c < 2; ++c) {
    const auto* channel = reinterpret_cast<const double*>(view.at(0, c, 0));
    CHECK(reinterpret_cast<std::uintptr_t>(channel) % 64 == 0);
    for (int i = 0; i < 3; ++i) CHECK(channel[i] == 3 * c + i + 1);
    CHECK(channel[3] == 0.0);
  }
}

TEST_CASE("memory: complex initial values are pairs") {
  plan::Buffer buffer;
  buffer.element = BF_C64;
  buffer.history = 2;
  buffer.capacity = 2;
  plan::Plan plan = one_buffer(buffer, 64);
  plan.initial[0] = {1, -1, 2, -2};
  const auto memory = Memory::make(plan);
  REQUIRE(memory);
  const auto* values = reinterpret_cast<const double*>((*memory)[0].at(0, 0, 0));
  CHECK(values[3] == -2.0);
  CHECK(values[4] == 0.0);
}

TEST_CASE("memory: a buffer that leaves its arena is refused") {
  plan::Buffer buffer;
  buffer.capacity = 8;
  buffer.slots = 2;
  const auto memory = Memory::make(one_buffer(buffer, 64));
  REQUIRE_FALSE(memory);
  CHECK(memory.error() == "plan: buffer 0 (128 bytes at 0) does not fit into the arena of partition 0");
}

}  // namespace
}  // namespace bodeflow::execute
