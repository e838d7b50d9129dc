#include "transport/shelf.hpp"

#include <algorithm>
#include <ctime>

#include "transport/ledger.hpp"

namespace bodeflow::transport {

bool Shelf::belongs(const Header& header) {
  if (!stream_ && (!edge_.open || edge_.stream != 0)) stream_ = edge_.stream;
  if (!stream_) stream_ = header.stream;
  return header.stream == *stream_;
}

std::optional<std::uint64_t> Shelf::place(const Header& header) {
  const bool joins_late = edge_.open || edge_.keeps_last || !edge_.lossless;
  if (header.epoch < epoch_) return std::nullopt;
  if (!begun_ || header.epoch > epoch_) {
    if (begun_) ++counted_.reconnects;
    epoch_ = header.epoch;
    expected_ = joins_late ? header.sequence : 0;
    begun_ = true;
  }
  if (header.sequence < expected_) return std::nullopt;
  const auto gap = header.sequence - expected_;
  expected_ = header.sequence + 1;
  return gap;
}

void Shelf::put(Way way, std::span<const std::byte> bytes) {
  auto decoded = decode(bytes);
  if (!decoded) {
    const std::lock_guard lock(mutex_);
    ++counted_.refused;
    return;
  }
  Item item{{std::move(decoded->header), {decoded->payload.begin(), decoded->payload.end()}}, way, 0};
  {
    const std::lock_guard lock(mutex_);
    if (!belongs(item.message.header)) {
      ++counted_.refused;
      return;
    }
    const auto gap = place(item.message.header);
    if (!gap) return;
    counted_.gaps += *gap;
    if (edge_.lossless) {
      item.gap = *gap;
    } else {
      items_.clear();
      queued_ = 0;
    }
    queued_ += item.message.payload.size();
    items_.push_back(std::move(item));
  }
  progress_.made();
  changed_.notify_one();  // without the lock: who wakes needs it
}

bool Shelf::room(Way way) {
  const std::lock_guard lock(mutex_);
  // Writers with credit stay within queue_bytes; others are held back here, and by the library's own history then.
  if (!edge_.lossless || items_.empty() || queued_ + Ledger::kOverhead * items_.size() <= edge_.queue_bytes) return true;
  left_[way] = true;
  any_left_.store(true);
  return false;
}

void Shelf::writer_matched(Way way, const middleware::Guid& writer, bool yes) {
  const std::lock_guard lock(mutex_);
  if (yes) {
    if (std::exchange(lost_, false)) ++counted_.reconnects;
    writers_[way].insert(writer);
    had_writer_ = true;
    compare_hosts();
  } else {
    writers_[way].erase(writer);
    lost_ = lost_ || (writers_[kFar].empty() && writers_[kNear].empty());
  }
  changed_.notify_all();
}

void Shelf::reader_is(Way way, const middleware::Guid& reader) {
  const std::lock_guard lock(mutex_);
  reader_[way] = reader;
  compare_hosts();
}

void Shelf::compare_hosts() {
  same_host_ = !writers_[kNear].empty();
  for (const auto& writer : writers_[kFar])
    same_host_ = same_host_ || (reader_[kFar] && middleware::same_host(*reader_[kFar], writer));
}

std::optional<Shelf::Item> Shelf::take(double seconds) {
  std::unique_lock lock(mutex_);
  if (items_.empty() && seconds > 0.0)
    changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !items_.empty(); });
  if (items_.empty()) return std::nullopt;
  auto item = std::move(items_.front());
  items_.pop_front();
  queued_ -= item.message.payload.size();
  count(item.message);
  return item;
}

std::array<bool, kWays> Shelf::claim_left() {
  if (!any_left_.load()) return {};
  const std::lock_guard lock(mutex_);
  if (queued_ + Ledger::kOverhead * items_.size() > edge_.queue_bytes) return {};
  any_left_.store(false);
  return std::exchange(left_, {});
}

void Shelf::count(const Message& message) {
  ++counted_.messages;
  counted_.bytes += message.payload.size();
  if (message.header.kind == Kind::samples) counted_.samples += message.header.count;
  if (!same_host_) return;
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const auto ns = std::int64_t{1000000000} * now.tv_sec + now.tv_nsec - message.header.source_ns;
  latencies_[latency_count_++ % latencies_.size()] = 1e-9F * static_cast<float>(ns);
}

bool Shelf::has_writer() const {
  const std::lock_guard lock(mutex_);
  return !writers_[kFar].empty() || !writers_[kNear].empty();
}

Failure Shelf::missing(const Item& item) const {
  const auto& header = item.message.header;
  return {Failure::Kind::peer, "topic '" + edge_.topic + "': " + std::to_string(item.gap) + " messages of stream " +
                                   std::to_string(header.stream) + " are missing before message " +
                                   std::to_string(header.sequence) + " of epoch " + std::to_string(header.epoch)};
}

Failure Shelf::failure(Failure::Kind kind) const {
  const std::lock_guard lock(mutex_);
  const auto where = "topic '" + edge_.topic + "': ";
  if (kind != Failure::Kind::tolerance) return {kind, where + "stopped"};
  const auto time = seconds_text(edge_.tolerance_s);
  if (!had_writer_) return {kind, where + "no writer came within " + time};
  const auto count = std::to_string(counted_.messages) + " messages";
  if (writers_[kFar].empty() && writers_[kNear].empty()) {
    return {Failure::Kind::peer, where + "the writer has gone after " + count + ", and none came for " + time};
  }
  return {kind, where + "nothing came for " + time + " after " + count};
}

void Shelf::tell(EdgeState& state) const {
  const std::lock_guard lock(mutex_);
  state = counted_;
  state.matched = !writers_[kFar].empty() || !writers_[kNear].empty();
  state.queued_bytes = queued_;
  state.waited_s = progress_.waited_s();
  state.stalled_s = progress_.stalled_s();
  const auto known = std::min(latency_count_, latencies_.size());
  if (known == 0) return;
  auto sorted = latencies_;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(known));
  state.latency_p50_s = static_cast<double>(sorted[known / 2]);
  state.latency_p99_s = static_cast<double>(sorted[known * 99 / 100]);
}

}  // namespace bodeflow::transport
