#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

#include "execute/time.hpp"
#include "plugins/instance.hpp"

namespace bodeflow::execute {

struct Asked;

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Something that a block takes before one of its firings.
struct Entry {
  enum class Kind {
    barrier,  ///< wait until an asynchronous block has done `job`: its records may be next
    record,   ///< for message input `port`, or graph::kParameterPort
    change    ///< of a live parameter: by the schedule, or asked for from outside
  };
  Kind kind = Kind::record;
  std::int64_t due = 0;       ///< the firing; blocks without streams go by `time` (of a live change: the period of the phase)
  Time time;                  ///< of effect: the producer's, and the latency
  int edge = 0;               ///< index into Phase::messages; kInitialEdge, kScheduleEdge
  std::int64_t sequence = 0;  ///< on that edge
  int port = 0;
  SharedRecord record;
  double made_s = 0.0;                    ///< when its producer made it
  int parameter = -1;                     ///< change
  const ParameterValue* value = nullptr;  ///< change: lives as long as the run
  bool live = false;                      ///< change: from outside, now or in the run that is repeated
  Asked* asked = nullptr;                 ///< change: from outside, now
  int worker = -1;                        ///< barrier: which asynchronous block
  std::int64_t job = 0;
};

inline constexpr int kInitialEdge = -2;
inline constexpr int kScheduleEdge = -1;

/// The order of effect: time, edge, barriers first, sequence.
bool before(const Entry& a, const Entry& b);

/// A time that may lie beyond all others.
struct Horizon {
  bool endless = false;
  Time time;

  bool beyond(const Time& t) const { return endless || t < time; }
};

/// What waits to be taken by one block, in order of effect. One thread takes; any thread sends.
class Inbox {
 public:
  /// [the thread that takes, or before the start]
  void add(Entry entry);
  /// [any thread] To be seen by the next `collect` that comes after whatever told the taker to look.
  void send(Entry entry);
  /// [any thread] The producer of message edge `edge` sends nothing more that takes effect before `horizon`.
  void announce(int edge, const Horizon& horizon);
  Horizon announced(int edge);

  /// [taker] Brings in what other threads sent.
  void collect() {
    if (sent_.load(std::memory_order_acquire)) bring_in();
  }
  bool empty() const { return head_ == entries_.size(); }
  std::int64_t next_due() const { return empty() ? kNever : entries_[head_].due; }
  const Entry& front() const { return entries_[head_]; }
  /// Whether anything but changes is there.
  bool has_records() const { return changes_ < entries_.size() - head_; }
  Entry pop();

 private:
  void bring_in();

  std::vector<Entry> entries_;  ///< in order from head_ on
  std::size_t head_ = 0;
  std::size_t changes_ = 0;  ///< entries of kind change among them
  std::atomic<bool> sent_{false};
  std::mutex mutex_;
  std::vector<Entry> incoming_;
  std::map<int, Horizon> announced_;
};

}  // namespace bodeflow::execute
