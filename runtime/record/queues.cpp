#include "record/queues.hpp"

#include <algorithm>
#include <bodeflow/record_layout.hpp>
#include <cstring>
#include <thread>

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

StreamQueue::StreamQueue(Origin origin, const StreamFacts& facts, std::size_t limit, bool polled)
    : origin_(std::move(origin)),
      channels_(std::max(1U, facts.channels)),
      element_bytes_(static_cast<std::size_t>(element_size(facts.element))),
      row_bytes_(element_bytes_ * channels_),
      capacity_(std::max<std::uint64_t>(2, limit / row_bytes_)),
      worth_(std::max<std::uint64_t>(1, std::min<std::uint64_t>(kWorth / row_bytes_, capacity_ / 4))),
      polled_(polled),
      ring_(new std::byte[capacity_ * row_bytes_]) {}

std::pair<std::uint64_t, bool> StreamQueue::put_some(const void* const* channels, std::uint64_t first, std::uint64_t count,
                                                     const std::atomic<bool>& refusing) {
  copying_ = true;  // before a look at `refusing`: `close` looks in the other order
  std::uint64_t fits = 0;
  const std::uint64_t before = waiting_rows();
  if (refusing) {
    fits = count;
  } else {
    const std::uint64_t at = put_ % capacity_;
    fits = std::min({count, capacity_ - before, capacity_ - at});
    std::byte* to = ring_.get() + at * row_bytes_;
    if (element_bytes_ == sizeof(double))
      interleave<double>(channels, channels_, first, fits, to);
    else
      interleave<std::complex<double>>(channels, channels_, first, fits, to);
    put_ += fits;
  }
  copying_ = false;
  return {fits, fits == 0 || (!polled_ && before < worth_ && before + fits >= worth_)};
}

void StreamQueue::wait_for_room(const std::atomic<bool>& refusing) {
  std::unique_lock lock(mutex_);
  stuck_ = true;
  room_.wait(lock, [&] { return waiting_rows() < capacity_ || refusing; });
  stuck_ = false;
}

std::span<const std::byte> StreamQueue::take(bool all) {
  taken_ += std::exchange(lent_, 0);
  if (stuck_) wake();
  const std::uint64_t waiting = waiting_rows();
  if (waiting == 0 || (!all && waiting < worth_)) return {};
  const std::uint64_t at = taken_ % capacity_;
  lent_ = std::min({waiting, capacity_ - at, capacity_ / 2});
  return {ring_.get() + at * row_bytes_, lent_ * row_bytes_};
}

void StreamQueue::wake() {
  const std::lock_guard lock(mutex_);
  room_.notify_all();
}

void StreamQueue::close() {
  while (copying_) std::this_thread::yield();
  ring_.reset();
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
