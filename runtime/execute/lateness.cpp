#include "execute/lateness.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace bodeflow::execute {
namespace {

constexpr std::int64_t kMicrosecond = 1000;  ///< in ns

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
  ++cells_[cell];
  min_ = chunks_ == 0 ? late : std::min(min_, late);
  max_ = std::max(max_, late);
  ++chunks_;
}

void LatenessCounter::add(const LatenessCounter& other) {
  if (other.chunks_ == 0) return;
  for (std::size_t i = 0; i < kCells; ++i) cells_[i] += other.cells_[i];
  min_ = chunks_ == 0 ? other.min_ : std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  chunks_ += other.chunks_;
}

/// The middle of the cell in which the chunk of that rank lies, never outside of what was met; seconds.
double LatenessCounter::quantile(double share) const {
  const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(chunks_)));
  std::uint64_t below = 0;
  std::size_t cell = 0;
  while (cell < kCells - 1 && below + cells_[cell] < rank) below += cells_[cell++];
  if (cell == kCells - 1) return static_cast<double>(max_) * 1e-9;
  const std::size_t octave = cell / kParts;
  const double start = octave == 0 ? 0.0 : std::ldexp(1e-6, static_cast<int>(octave) - 1);
  const double width = octave == 0 ? 1e-6 : start;
  const double middle = start + width * (static_cast<double>(cell % kParts) + 0.5) / static_cast<double>(kParts);
  return std::clamp(middle, static_cast<double>(min_) * 1e-9, static_cast<double>(max_) * 1e-9);
}

Lateness LatenessCounter::summary() const {
  Lateness all;
  if (chunks_ == 0) return all;
  all.chunks = chunks_;
  all.min_s = static_cast<double>(min_) * 1e-9;
  all.max_s = static_cast<double>(max_) * 1e-9;
  all.median_s = quantile(0.5);
  all.p99_s = quantile(0.99);
  all.bins.resize(Lateness::kBins);
  for (std::size_t i = 0; i < kCells; ++i) all.bins[i / kParts] += cells_[i];
  return all;
}

}  // namespace bodeflow::execute
