#pragma once

#include <condition_variable>
#include <deque>
#include <set>

#include "transport/participant.hpp"
#include "transport/progress.hpp"

namespace bodeflow::transport {

/// Where an inlet's messages wait, in order and each once: bounded, filled by threads of the library, emptied by the inlet's.
class Shelf {
 public:
  explicit Shelf(const Edge& edge) : edge_(edge), progress_(edge.tolerance_s), epoch_(edge.epoch) {}

  struct Item {
    Message message;
    Way way = kFar;
    std::uint64_t gap = 0;  ///< messages that are missing before it
  };

  void put(Way way, std::span<const std::byte> bytes);
  /// False: what comes must wait with the library; take() says when there is room again.
  bool room(Way way);
  void writer_matched(Way way, const middleware::Guid& writer, bool yes);
  /// The identifier of the reader on that way: latencies are told of writers on the same host only.
  void reader_is(Way way, const middleware::Guid& reader);

  /// Waits at most `seconds`; nothing: none came.
  std::optional<Item> take(double seconds);
  /// Ways on which something was left with the library and has room now; the mark is gone then.
  std::array<bool, kWays> claim_left();

  bool has_writer() const;
  /// What was missing before a message that is handed over afterwards.
  Failure missing(const Item& item) const;
  Failure failure(Failure::Kind kind) const;
  void tell(EdgeState& state) const;
  Progress& progress() { return progress_; }

 private:
  bool belongs(const Header& header);
  /// Messages missing before this one; nothing: it was here before.
  std::optional<std::uint64_t> place(const Header& header);
  void count(const Message& message);
  void compare_hosts();

  const Edge edge_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Progress progress_;
  std::array<std::set<middleware::Guid>, kWays> writers_;
  std::array<std::optional<middleware::Guid>, kWays> reader_;
  bool had_writer_ = false, lost_ = false, same_host_ = false;
  std::array<bool, kWays> left_{};
  std::atomic<bool> any_left_{false};
  std::deque<Item> items_;
  std::uint64_t queued_ = 0;  // payload bytes
  bool begun_ = false;
  std::optional<std::uint64_t> stream_;
  std::uint32_t epoch_;
  std::uint64_t expected_ = 0;
  EdgeState counted_;
  std::array<float, 512> latencies_{};  // s, the newest
  std::size_t latency_count_ = 0;
};

}  // namespace bodeflow::transport
