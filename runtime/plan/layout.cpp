#include <algorithm>
#include <numeric>
#include <tuple>

#include "plan/memory.hpp"

namespace bodeflow::plan {

Layout lay_out(const std::vector<Lifetime>& lifetimes) {
  std::vector<int> sequence(lifetimes.size());
  std::iota(sequence.begin(), sequence.end(), 0);
  const auto key = [&](int i) { return std::tuple(~lifetimes[i].bytes, lifetimes[i].first, i); };
  std::sort(sequence.begin(), sequence.end(), [&](int a, int b) { return key(a) < key(b); });

  Layout layout;
  layout.offsets.assign(lifetimes.size(), 0);
  std::vector<int> placed;  // by offset
  for (const int index : sequence) {
    const Lifetime& mine = lifetimes[index];
    std::uint64_t offset = 0;
    for (const int other : placed) {
      const Lifetime& theirs = lifetimes[other];
      if (theirs.last < mine.first || mine.last < theirs.first) continue;
      if (offset + mine.bytes <= layout.offsets[other]) break;
      offset = std::max(offset, layout.offsets[other] + theirs.bytes);
    }
    layout.offsets[index] = offset;
    layout.bytes = std::max(layout.bytes, offset + mine.bytes);
    const auto position =
        std::upper_bound(placed.begin(), placed.end(), offset, [&](std::uint64_t o, int b) { return o < layout.offsets[b]; });
    placed.insert(position, index);
  }
  return layout;
}

}  // namespace bodeflow::plan
