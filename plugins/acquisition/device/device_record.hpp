#pragma once

#include <bodeflow/block.hpp>

#include "device_clock.hpp"

namespace bodeflow::acquisition {

/// Why samples are missing.
enum class GapCause {
  overrun,   ///< the device had samples that were not taken in time
  underrun,  ///< the device wanted samples that were not there in time
  loss       ///< its own time stamps say so
};
const char* name_of(GapCause cause);

/// A place in a stream where time went by without samples.
struct Gap {
  std::int64_t position = 0;  ///< of the first sample behind it
  GapCause cause = GapCause::overrun;
  std::optional<std::int64_t> missing;  ///< samples, where known
};

/// "overrun before sample 4096, 512 samples are missing".
std::string text_of(const Gap& gap);

/// Record `gap`: position, cause, missing (-1 where not known).
RecordBuilder gap_record(const Gap& gap);

/// What is told of a device at the end of a run.
struct DeviceReport {
  std::string device, clock;
  double rate_hz = 0.0;
  std::int64_t samples = 0;
  std::int64_t overruns = 0, underruns = 0, losses = 0, missing = 0, clipped = 0;
  std::int64_t round_trip_delay = 0, lead = 0, period = 0, buffer = 0;

  /// Counts a gap.
  void count(const Gap& gap);
  /// "3 gaps (3 overruns), 1200 samples missing", or "no gaps".
  std::string gaps_text() const;
};

/// Record `device`: the report, `measured_rate` [Hz] (NaN where the run was too short) and arrays `position`, `time` [s] of
/// the stamps.
RecordBuilder device_record(const DeviceReport& report, const DeviceClock& clock);

/// Throws Failure where the run's clock does not go by real time: a device can't be waited for in simulated time.
void require_realtime(const Activation& a);

/// What to do about calls that last so long that Ctrl-C has to wait for them; "" for short ones.
std::string advice_on_calls(const Activation& a);

/// Describes `device`, the report at the end, and `gaps`.
void describe_device_ports(Describe& d, MessageOut device, MessageOut gaps);

/// Describes on_gap.
void describe_on_gap(Describe& d);

}  // namespace bodeflow::acquisition
