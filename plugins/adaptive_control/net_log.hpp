#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "acceptance.hpp"
#include "watchdog.hpp"

namespace bodeflow::adaptive_control {

/// The safety nets, in the order of the signals.
enum class Net { excitation, covariance, huber, ladder, kept, rate, retreat };

/// The name of a net as it stands in records.
const char* name_of(Net net);

/// A net began to act, or stopped.
struct NetEvent {
  Net net = Net::excitation;
  bool begins = true;
  int band = -1;                          ///< index of the frequency of fitting, -1 for the design
  std::int64_t sample = 0;                ///< at which it happened
  double value = 0.0, limit = 0.0;        ///< what was found, and the limit that it broke
  Refusal refusal = Refusal::none;        ///< why a design was refused
  Departure departure = Departure::none;  ///< why a controller was given up
};

/// A net that must rest for `hold` samples before its end is told, so that a log has transitions and not every sample.
class NetState {
 public:
  explicit NetState(int hold = 50) : hold_(hold) {}

  enum class Change { none, begins, ends };
  Change step(bool acts) {
    acted_ += acts ? 1 : 0;
    if (acts) {
      rested_ = 0;
      if (active_) return Change::none;
      active_ = true;
      return Change::begins;
    }
    if (!active_ || ++rested_ < hold_) return Change::none;
    active_ = false;
    return Change::ends;
  }

  bool active() const { return active_; }
  /// Samples at which it acted.
  std::int64_t acted() const { return acted_; }

 private:
  int hold_;
  int rested_ = 0;
  bool active_ = false;
  std::int64_t acted_ = 0;
};

/// Events until they are fetched, without allocation; what does not fit is counted.
class NetLog {
 public:
  void add(const NetEvent& event) {
    if (count_ < events_.size()) {
      events_[count_++] = event;
    } else {
      ++lost_;
    }
  }
  std::size_t count() const { return count_; }
  const NetEvent& operator[](std::size_t i) const { return events_[i]; }
  std::int64_t lost() const { return lost_; }
  void clear() { count_ = 0; }

 private:
  std::array<NetEvent, 128> events_;
  std::size_t count_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace bodeflow::adaptive_control
