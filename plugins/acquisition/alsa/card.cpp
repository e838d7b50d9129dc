#include "card.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/sampling.hpp"

namespace bodeflow::acquisition {

void describe_card(Describe& d) {
  d.parameter("device", "default").doc("name of the device as ALSA knows it: `hw:0`, `hw:CARD=UR22`, or one of an asoundrc");
  d.optional<std::string>("clock").doc(
      "clock domain of the device; `alsa:` and its name without it. Blocks on one card share one: give all the same");
  d.parameter("format", "s32")
      .choices(sample_formats())
      .doc("how samples are coded, little-endian; s24 stands in four bytes, s24_3le in three. Nothing is converted on the way");
  d.parameter("period", std::int64_t{256}).range(8, 1 << 20).doc("frames between two interrupts of the device");
  d.parameter("buffer", std::int64_t{4096}).range(16, 1 << 24).doc("frames that the device buffers; at least two periods");
  d.parameter("timeout", 2.0).unit("s").range(0.05, 60).doc("a device that moves no sample for so long ends the run");
  describe_on_gap(d);
}

Card read_card(const Parameters& p) {
  Card card;
  card.spec.device = p.text("device");
  if (card.spec.device.empty()) fail("device is empty; allowed: the name of an ALSA device such as hw:0");
  card.clock = p.has("clock") ? p.text("clock") : "alsa:" + card.spec.device;
  card.spec.format = *sample_format(p.text("format"));
  card.spec.period = static_cast<std::size_t>(p.integer("period"));
  card.spec.buffer = static_cast<std::size_t>(p.integer("buffer"));
  if (card.spec.buffer < 2 * card.spec.period)
    fail("a buffer of " + std::to_string(card.spec.buffer) + " frames with a period of " + std::to_string(card.spec.period) +
         "; allowed: at least two periods");
  card.spec.timeout_s = p.number("timeout");
  card.mark_gaps = p.text("on_gap") == "mark";
  return card;
}

unsigned whole_rate(const Rate& rate) {
  if (rate.den != 1 || rate.num < 1 || rate.num > 10'000'000)
    fail("a sample rate of " + number_text(rate.hz()) + " Hz; a sound device takes whole numbers of hertz up to 10 MHz");
  return static_cast<unsigned>(rate.num);
}

void require_finite(std::span<const double> values, std::uint64_t first, int channel) {
  const auto bad = std::find_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); });
  if (bad == values.end()) return;
  fail("sample " + std::to_string(first + static_cast<std::uint64_t>(bad - values.begin())) + " of channel " +
       std::to_string(channel + 1) + " is " + number_text(*bad) + "; a converter takes finite values");
}

void BreakCounter::broke() {
  constexpr int kMost = 8;
  if (++breaks_ == kMost) fail("the device breaks off at each start, " + std::to_string(kMost) + " times in a row");
}

std::optional<std::int64_t> samples_missing(const DeviceClock& clock, const TimeStamp& next, const Rate& rate) {
  if (!clock.last()) return std::nullopt;
  const double due_s = clock.last()->time_s + static_cast<double>(next.position - clock.last()->position) / rate.hz();
  return std::max<std::int64_t>(0, std::llround((next.time_s - due_s) * rate.hz()));
}

void describe_ac_corner(Describe& d) {
  d.optional<double>("ac_corner")
      .unit("Hz")
      .above(0.0)
      .doc(
          "measured -3 dB frequency of the AC coupling; below ten times of it a first-order coupling turns the phase by more "
          "than 5.7 "
          "deg. It is noted in the stream, and `bodeflow check` warns of lines there");
}

void note_ac_corner(const std::optional<double>& corner_hz, StreamFacts& facts) {
  if (corner_hz) facts.notes["sensor.ac_corner"] = {*corner_hz};
}

}  // namespace bodeflow::acquisition
