#include "execute/lateness.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace bodeflow::execute {
namespace {

constexpr std::int64_t kMicrosecond = 1000;  ///< in ns
constexpr auto kPlain = std::memory_order_relaxed;

/// One thread writes: no need of an atomic addition.
void raise(std::atomic<std::uint64_t>& count, std::uint64_t by) { count.store(count.load(kPlain) + by, kPlain); }

}  // namespace

void LatenessCounter::add(std::int64_t nanoseconds) {
  const std::int64_t late = std::max<std::int64_t>(nanoseconds, 0);
  const auto microseconds = static_cast<std::uint64_t>(late / kMicrosecond);
  const auto octave = static_cast<std::size_t>(std::bit_width(microseconds));  // 0: below 1 us
  std::size_t cell = kCells - 1;
  if (octave < Lateness::kBins - 1) {
    const std::int64_t start = octave == 0 ? 0 : kMicrosecond << (octave - 1);
    const std::int64_t width = octave == 0 ? kMicrosecond : start;
    cell = octave * kParts + static_cast<std::size_t>((late - start) * static_cast<std::int64_t>(kParts) / width);
  }
  const std::uint64_t chunks = chunks_.load(kPlain);
  if (chunks == 0 || late < min_.load(kPlain)) min_.store(late, kPlain);
  if (late > max_.load(kPlain)) max_.store(late, kPlain);
  raise(cells_[cell], 1);
  chunks_.store(chunks + 1, std::memory_order_release);
}

void LatenessCounter::add(const LatenessCounter& other) {
  const std::uint64_t added = other.chunks_.load(std::memory_order_acquire);
  if (added == 0) return;
  const std::uint64_t chunks = chunks_.load(kPlain);
  for (std::size_t i = 0; i < kCells; ++i) raise(cells_[i], other.cells_[i].load(kPlain));
  const std::int64_t least = other.min_.load(kPlain);
  if (chunks == 0 || least < min_.load(kPlain)) min_.store(least, kPlain);
  max_.store(std::max(max_.load(kPlain), other.max_.load(kPlain)), kPlain);
  chunks_.store(chunks + added, std::memory_order_release);
}

Lateness LatenessCounter::summary() const {
  Lateness all;
  all.chunks = chunks_.load(std::memory_order_acquire);
  if (all.chunks == 0) return all;
  std::array<std::uint64_t, kCells> cells{};
  std::uint64_t counted = 0;  // may be more than `chunks` while a thread adds
  for (std::size_t i = 0; i < kCells; ++i) counted += cells[i] = cells_[i].load(kPlain);
  const double least = static_cast<double>(min_.load(kPlain)) * 1e-9, most = static_cast<double>(max_.load(kPlain)) * 1e-9;
  // The middle of the cell in which the chunk of that rank lies, never outside of what was met.
  const auto quantile = [&](double share) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(counted)));
    std::uint64_t below = 0;
    std::size_t cell = 0;
    while (cell < kCells - 1 && below + cells[cell] < rank) below += cells[cell++];
    if (cell == kCells - 1) return most;
    const std::size_t octave = cell / kParts;
    const double start = octave == 0 ? 0.0 : std::ldexp(1e-6, static_cast<int>(octave) - 1);
    const double width = octave == 0 ? 1e-6 : start;
    const double middle = start + width * (static_cast<double>(cell % kParts) + 0.5) / static_cast<double>(kParts);
    return std::clamp(middle, least, std::max(least, most));
  };
  all.min_s = least;
  all.max_s = most;
  all.median_s = quantile(0.5);
  all.p99_s = quantile(0.99);
  all.bins.resize(Lateness::kBins);
  for (std::size_t i = 0; i < kCells; ++i) all.bins[i / kParts] += cells[i];
  return all;
}

}  // namespace bodeflow::execute
