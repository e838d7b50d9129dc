#pragma once

#include "plan/links.hpp"

namespace bodeflow::plan {

/// A link inside a loop, with the loop's own numbering of blocks and time in periods of the loop.
struct LoopLink {
  int from = 0, to = 0;  ///< index into LoopModel::blocks
  const Link* link = nullptr;
  Rate latency;              ///< messages: in periods of the loop
  std::int64_t granted = 0;  ///< streams: samples beyond the delay, lent to find out what is missing
  bool ignored = false;      ///< messages: not waited for, for the same purpose
};

/// A feedback loop by itself: one period is the shortest time in which every block fires a whole number of times.
struct LoopModel {
  std::vector<int> blocks;
  std::vector<std::int64_t>
      firings;  ///< of each block in one period; blocks without streams: turns on the finest grid of the others
  std::vector<bool> has_streams;
  std::vector<LoopLink> links;
  std::int64_t parts = 1;  ///< periods of the loop in one period of the phase

  /// How many firings of the producer of a message link must be done before firing `index` of its consumer.
  std::int64_t needed(const LoopLink& link, std::int64_t index) const;

  /// How many periods the consumer of a link can run ahead of the producer (at least `most`: as many as wanted).
  std::int64_t lead(const LoopLink& link, std::int64_t most) const;
};

LoopModel loop_model(const Facts& facts, const std::vector<int>& blocks, const std::vector<Link>& links);

}  // namespace bodeflow::plan
