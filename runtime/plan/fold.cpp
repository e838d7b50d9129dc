#include "plan/fold.hpp"

#include <algorithm>

namespace bodeflow::plan {
namespace {

/// Longest part that is looked for.
constexpr std::size_t kLongestPart = 64;

bool same(const Firing& a, const Firing& b) { return a.block == b.block && a.count == b.count && a.to_buffer == b.to_buffer; }

/// How often the `length` entries from `start` on follow each other.
std::size_t repeats(const std::vector<Firing>& schedule, std::size_t start, std::size_t length) {
  std::size_t times = 1;
  for (std::size_t next = start + length; next + length <= schedule.size(); next += length, ++times) {
    if (!std::equal(schedule.begin() + static_cast<std::ptrdiff_t>(start),
                    schedule.begin() + static_cast<std::ptrdiff_t>(start + length),
                    schedule.begin() + static_cast<std::ptrdiff_t>(next), same)) {
      break;
    }
  }
  return times;
}

}  // namespace

std::vector<Fold> fold_schedule(const std::vector<Firing>& schedule) {
  std::vector<Fold> folds;
  std::size_t at = 0;
  while (at < schedule.size()) {
    std::size_t length = 1, times = 1;
    for (std::size_t candidate = 1; candidate <= std::min(kLongestPart, schedule.size() - at); ++candidate) {
      const std::size_t found = repeats(schedule, at, candidate);
      if (found > 1 && found * candidate > times * length) {
        length = candidate;
        times = found;
      }
    }
    const auto begin = schedule.begin() + static_cast<std::ptrdiff_t>(at);
    const std::vector<Firing> part(begin, begin + static_cast<std::ptrdiff_t>(length));
    if (times == 1 && !folds.empty() && folds.back().times == 1) {
      folds.back().firings.insert(folds.back().firings.end(), part.begin(), part.end());
    } else {
      folds.push_back({static_cast<std::int64_t>(times), part});
    }
    at += length * times;
  }
  return folds;
}

}  // namespace bodeflow::plan
