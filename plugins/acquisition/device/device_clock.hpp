#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace bodeflow::acquisition {

/// A sample of a device and the time at which it was taken, on the monotonic clock of the machine.
struct TimeStamp {
  std::int64_t position = 0;
  double time_s = 0.0;
};

/// What a device's clock is worth on the clock of the machine: time stamps kept in bounded memory, and the rate that they show.
class DeviceClock {
 public:
  /// Time stamps kept, at most; of more every second one is left out.
  static constexpr std::size_t kMost = 2048;

  /// Takes a stamp of a later position than the last. Stamps closer than the present spacing are passed over, save as `last`.
  void add(TimeStamp stamp);
  /// The device started anew with this sample: the rate is that of the longest stretch without a gap.
  void start_anew(TimeStamp first);
  void reset();

  const std::optional<TimeStamp>& last() const { return last_; }
  const std::vector<TimeStamp>& stamps() const { return stamps_; }
  /// Samples per second by the first and the last stamp of the longest stretch; none before it lasts half a second.
  std::optional<double> rate_hz() const;

 private:
  struct Stretch {
    TimeStamp first, last;
    double duration_s() const { return last.time_s - first.time_s; }
  };

  std::vector<TimeStamp> stamps_;
  double spacing_s_ = 0.1;
  std::optional<TimeStamp> last_;
  std::optional<Stretch> now_, longest_;
};

/// Seconds on the monotonic clock of the machine.
double monotonic_s();

}  // namespace bodeflow::acquisition
