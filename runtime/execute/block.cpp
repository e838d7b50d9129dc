#include "execute/block.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "execute/run.hpp"

namespace bodeflow::execute {

void rewind(BlockRun& block) {
  for (std::size_t i = 0; i < block.ports.size(); ++i) block.streams[i].offset = block.ports[i].base;
}

void begin_chunk(BlockRun& block, const Chunk& chunk) {
  rewind(block);
  if (!block.rotates) return;
  for (std::size_t i = 0; i < block.ports.size(); ++i) {
    const auto& channels = block.ports[i].channels;
    if (channels.size() > 1) block.streams[i].channels = channels[static_cast<std::size_t>(chunk.index) % channels.size()].data();
  }
}

void set_count(BlockRun& block, std::int64_t count) {
  block.count = count;
  for (std::size_t i = 0; i < block.ports.size(); ++i)
    block.streams[i].count = static_cast<std::uint64_t>(count) * block.ports[i].samples;
}

bool settle(BlockRun& block, std::int32_t status) {
  Control& control = block.run->control;
  if (control.stopping()) return false;
  if (block.fault) {
    control.fail(block.index, block.fault_text);
    return false;
  }
  if (block.guard != nullptr && block.guard->stopped() >= 0) {
    block.position += static_cast<std::int64_t>(block.process.done);
    control.violate(block.guard->stopped());
    return false;
  }
  if (status != BF_OK) {
    std::string reason = block.instance->take_error();
    control.fail(block.index, reason.empty() ? "failed without a reason" : std::move(reason));
    return false;
  }
  const std::uint64_t done = block.process.done, count = static_cast<std::uint64_t>(block.count);
  if (done == count) return true;
  if (done > count) {
    control.fail(block.index, fmt::format("says that it made {} firings where {} were asked for", done, count));
    return false;
  }
  if (!block.source) {
    control.fail(block.index,
                 fmt::format("made {} of {} firings: only a block without stream inputs may end its streams", done, count));
    return false;
  }
  block.position += static_cast<std::int64_t>(done);
  block.end.store(block.position, std::memory_order_relaxed);
  block.run->ends_changed.store(true, std::memory_order_relaxed);
  return true;
}

bool update_end(BlockRun& block) {
  std::int64_t end = block.end.load(std::memory_order_relaxed);
  const std::int64_t was = end;
  for (const Feed& feed : block.feeds) {
    const std::int64_t firings = block.run->block(feed.block).end.load(std::memory_order_relaxed);
    const __int128 enough = static_cast<__int128>(firings) * feed.produced / feed.consumed;
    if (firings != kNever && enough < end) end = static_cast<std::int64_t>(enough);
  }
  if (end == was) return false;
  block.end.store(end, std::memory_order_relaxed);
  return true;
}

}  // namespace bodeflow::execute
