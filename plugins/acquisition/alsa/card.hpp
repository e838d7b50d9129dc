#pragma once

#include "acquisition/device/channels.hpp"
#include "acquisition/device/device_record.hpp"
#include "pcm.hpp"

namespace bodeflow::acquisition {

/// What the ALSA blocks are told of a sound card.
struct Card {
  PcmSpec spec;  ///< without direction, rate and channels
  std::string clock;
  bool mark_gaps = false;
};

/// Describes device, clock, format, period, buffer, timeout, on_gap.
void describe_card(Describe& d);
Card read_card(const Parameters& p);

/// The rate as libasound takes it. Throws Failure for one that is no whole number of hertz.
unsigned whole_rate(const Rate& rate);

/// Throws Failure for a sample that is not finite.
void require_finite(std::span<const double> values, std::uint64_t first, int channel);

/// Counts breaks between which no frame was moved: a device that breaks off eight times in a row will not recover.
class BreakCounter {
 public:
  void moved(std::size_t frames) { breaks_ = frames > 0 ? 0 : breaks_; }
  /// Throws Failure at the eighth.
  void broke();

 private:
  int breaks_ = 0;
};

/// How long a device stood still: from where its last stamp puts the sample that comes next to the time at which it was taken, in
/// samples. None without a stamp.
std::optional<std::int64_t> samples_missing(const DeviceClock& clock, const TimeStamp& next, const Rate& rate);

/// Describes ac_corner, the -3 dB frequency of an AC-coupled input, and notes it in the facts of a stream as `sensor.ac_corner`.
void describe_ac_corner(Describe& d);
void note_ac_corner(const std::optional<double>& corner_hz, StreamFacts& facts);

}  // namespace bodeflow::acquisition
