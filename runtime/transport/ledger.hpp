#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <set>

#include "transport/credit.hpp"
#include "transport/participant.hpp"
#include "transport/progress.hpp"

namespace bodeflow::transport {

/// Who reads what an outlet sends, on which way, and how far each has come. Knows no network: it is told.
///
/// One way carries a stream, chosen when the expected readers are there: two would mix the order. It changes only when nobody is
/// left on it.
class Ledger {
 public:
  Ledger(const Edge& edge, bool has_near) : edge_(edge), has_near_(has_near), progress_(edge.tolerance_s) {}

  /// What one message costs of the credit, beyond its payload: its place in the queues.
  static constexpr std::uint64_t kOverhead = 256;

  void reader_matched(Way way, const middleware::Guid& reader, bool yes);
  void credit(Way way, const Credit& credit, bool same_host);
  void refused();

  /// Waits for the expected readers; then: the way to use.
  tl::expected<Way, Failure> wait_for_readers(const GoOn& go_on);
  struct Ticket {
    Way way = kFar;
    std::uint64_t sequence = 0;
  };
  /// Waits for readers and for credit of `payload` bytes, and books them.
  tl::expected<Ticket, Failure> book(std::uint64_t payload, const GoOn& go_on);
  /// Books without any wait.
  std::uint64_t book_latest();

  bool has_readers(Way way) const;
  bool still_there() const;
  std::uint64_t sent() const;
  /// What to say when a call gave up.
  Failure failure(Failure::Kind kind) const;
  /// Fills what it knows.
  void tell(EdgeState& state) const;
  Progress& progress() { return progress_; }

 private:
  struct Inlet {
    std::array<std::optional<middleware::Guid>, kWays> reader;
    bool near = false, same_host = false;
    std::uint64_t taken = 0;
  };
  bool lives(const Inlet& inlet, Way way) const;
  int living(Way way) const;
  bool choose();
  bool fits(std::uint64_t cost);
  std::uint64_t spent_at(std::uint64_t sequence) const;
  std::uint64_t least_taken() const;
  void forget_taken();
  Failure give_up(Failure::Kind kind) const;

  const Edge edge_;
  const bool has_near_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Progress progress_;
  std::array<std::set<middleware::Guid>, kWays> readers_;
  std::map<std::uint64_t, Inlet> inlets_;
  std::optional<Way> way_;
  std::optional<std::chrono::steady_clock::time_point> near_awaited_;
  bool was_ready_ = false, lost_ = false;
  std::uint64_t sent_ = 0, spent_ = 0;  // messages; their cost so far
  std::uint64_t first_ = 0;             // sequence of the front of spends_
  std::deque<std::uint64_t> spends_;    // cost so far after each message that somebody has not taken
  std::uint64_t untaken_of_gone_ = 0;   // messages that readers had not taken when they went
  std::uint64_t refused_ = 0;
  std::uint32_t reconnects_ = 0;
};

}  // namespace bodeflow::transport
