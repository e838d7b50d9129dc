#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "plugins/sha256.hpp"
#include "record/data_writer.hpp"

namespace bodeflow::record {

/// Samples of one stream between the thread that makes them and the one that writes them, interleaved. One thread on each side;
/// `put` takes no lock as long as there is room.
class StreamQueue {
 public:
  /// `limit`: bytes that may wait. `polled`: the writer looks by itself, `put` urges it only when there is no room.
  StreamQueue(Origin origin, const StreamFacts& facts, std::size_t limit, bool polled);

  /// Copies samples in; waits for room unless `refusing`. `urge` is called when enough waits to be worth a write.
  template <class Urge>
  void put(const void* const* channels, std::uint64_t count, const std::atomic<bool>& refusing, Urge urge) {
    for (std::uint64_t done = 0; done < count && !refusing;) {
      const auto [copied, urgent] = put_some(channels, done, count - done, refusing);
      done += copied;
      if (urgent) urge();
      if (copied == 0) wait_for_room(refusing);
    }
  }
  /// Takes what waits if it is worth a write, or in any case: up to the end of the ring and at most half of it, so that three
  /// calls take all. The rows stay valid until the next call, which lets them go. Empty: nothing.
  std::span<const std::byte> take(bool all);
  /// Counts rows that were written into the hash.
  void written(std::span<const std::byte> rows) { hash_.update(rows.data(), rows.size()); }
  /// Lets a waiting `put` look at `refusing` again.
  void wake();
  /// Gives the memory back; `refusing` is true, and stays so.
  void close();

  std::uint64_t rows_in(std::span<const std::byte> rows) const { return rows.size() / row_bytes_; }
  const Origin& origin() const { return origin_; }
  std::string hash() const { return hash_.hex(); }

 private:
  /// Rows that were copied, and whether the writer should come.
  std::pair<std::uint64_t, bool> put_some(const void* const* channels, std::uint64_t first, std::uint64_t count,
                                          const std::atomic<bool>& refusing);
  void wait_for_room(const std::atomic<bool>& refusing);
  std::uint64_t waiting_rows() const { return put_ - taken_; }

  Origin origin_;
  std::uint32_t channels_;
  std::size_t element_bytes_, row_bytes_;
  std::uint64_t capacity_, worth_;  ///< rows
  bool polled_;
  std::unique_ptr<std::byte[]> ring_;
  std::atomic<std::uint64_t> put_ = 0, taken_ = 0;  ///< rows since the begin
  std::uint64_t lent_ = 0;                          ///< rows that the last `take` gave
  std::atomic<bool> copying_ = false, stuck_ = false;
  std::mutex mutex_;  ///< of a `put` without room
  std::condition_variable room_;
  Sha256 hash_;
};

/// Records of one message output between the threads; they are shared, not copied.
class RecordQueue {
 public:
  explicit RecordQueue(Origin origin) : origin_(std::move(origin)) {}

  /// Adds a record; waits for room unless `refusing`. True when enough waits to be worth a write.
  bool put(const SharedRecord& record, double time_s, const std::atomic<bool>& refusing);
  std::vector<TimedRecord> take();
  void written(const std::vector<TimedRecord>& records);
  /// Lets a waiting `put` look at `refusing` again.
  void wake();
  /// Lets the last record go; `refusing` stays true from now on.
  void close();

  const Origin& origin() const { return origin_; }
  SharedRecord last() const;
  std::string hash() const { return hash_.hex(); }

 private:
  Origin origin_;
  mutable std::mutex mutex_;
  std::condition_variable space_;
  std::vector<TimedRecord> waiting_;
  std::size_t waiting_bytes_ = 0;
  SharedRecord last_;
  Sha256 hash_;
};

}  // namespace bodeflow::record
