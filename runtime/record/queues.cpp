#include "record/queues.hpp"

#include <algorithm>
#include <bodeflow/record_layout.hpp>
#include <cstring>

namespace bodeflow::record {
namespace {

/// Waiting bytes that are worth a write of their own.
constexpr std::size_t kWorth = std::size_t{512} << 10U;
constexpr std::size_t kRecordLimit = std::size_t{32} << 20U;

template <class T>
void interleave(const void* const* channels, std::size_t channel_count, std::uint64_t first, std::uint64_t count, std::byte* to) {
  for (std::size_t c = 0; c < channel_count; ++c) {
    const T* in = static_cast<const T*>(channels[c]) + first;
    if (channel_count == 1) {
      std::memcpy(to, in, count * sizeof(T));
      return;
    }
    std::byte* out = to + c * sizeof(T);
    for (std::uint64_t n = 0; n < count; ++n, out += channel_count * sizeof(T)) std::memcpy(out, in + n, sizeof(T));
  }
}

}  // namespace

StreamQueue::StreamQueue(Origin origin, const StreamFacts& facts, std::size_t limit)
    : origin_(std::move(origin)),
      channels_(std::max(1U, facts.channels)),
      element_bytes_(static_cast<std::size_t>(element_size(facts.element))),
      row_bytes_(element_bytes_ * channels_),
      limit_(std::max(limit, row_bytes_)),
      worth_(std::min(kWorth, limit_ / 2)),
      filling_(new std::byte[limit_]),
      writing_(new std::byte[limit_]) {}

std::pair<std::uint64_t, bool> StreamQueue::put_some(const void* const* channels, std::uint64_t first, std::uint64_t count,
                                                     const std::atomic<bool>& refusing) {
  std::unique_lock lock(mutex_);
  space_.wait(lock, [&] { return filled_ + row_bytes_ <= limit_ || refusing; });
  if (refusing) return {count, false};
  const std::uint64_t fits = std::min<std::uint64_t>(count, (limit_ - filled_) / row_bytes_);
  if (element_bytes_ == sizeof(double))
    interleave<double>(channels, channels_, first, fits, filling_.get() + filled_);
  else
    interleave<std::complex<double>>(channels, channels_, first, fits, filling_.get() + filled_);
  const bool before = filled_ >= worth_;
  filled_ += fits * row_bytes_;
  return {fits, !before && filled_ >= worth_};
}

std::span<const std::byte> StreamQueue::take(bool all) {
  const std::lock_guard lock(mutex_);
  if (filled_ == 0 || (!all && filled_ < worth_)) return {};
  std::swap(filling_, writing_);
  const std::size_t size = std::exchange(filled_, 0);
  space_.notify_all();
  return {writing_.get(), size};
}

void StreamQueue::wake() {
  const std::lock_guard lock(mutex_);
  space_.notify_all();
}

void StreamQueue::close() {
  const std::lock_guard lock(mutex_);
  filling_.reset();
  writing_.reset();
  filled_ = 0;
}

bool RecordQueue::put(const SharedRecord& record, double time_s, const std::atomic<bool>& refusing) {
  std::unique_lock lock(mutex_);
  if (!refusing) last_ = record;
  space_.wait(lock, [&] { return waiting_.empty() || waiting_bytes_ + record.size() <= kRecordLimit || refusing; });
  if (refusing) return false;
  waiting_.push_back({record, time_s});
  const bool before = waiting_bytes_ >= kWorth;
  waiting_bytes_ += record.size();
  return !before && waiting_bytes_ >= kWorth;
}

std::vector<TimedRecord> RecordQueue::take() {
  const std::lock_guard lock(mutex_);
  waiting_bytes_ = 0;
  space_.notify_all();
  return std::exchange(waiting_, {});
}

void RecordQueue::wake() {
  const std::lock_guard lock(mutex_);
  space_.notify_all();
}

void RecordQueue::close() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
  last_ = {};
}

void RecordQueue::written(const std::vector<TimedRecord>& records) {
  for (const auto& [record, time_s] : records) {
    const std::uint64_t size = record.size();
    hash_.update(&time_s, sizeof time_s);
    hash_.update(&size, sizeof size);
    hash_.update(record.bytes(), record.size());
  }
}

SharedRecord RecordQueue::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

}  // namespace bodeflow::record
