#include "device_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/number_line.hpp"
#include "acquisition/sampling.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr double kLongCall_s = 2.0;

}  // namespace

const char* name_of(GapCause cause) {
  return cause == GapCause::overrun ? "overrun" : cause == GapCause::underrun ? "underrun" : "loss";
}

std::string text_of(const Gap& gap) {
  std::string text = std::string(name_of(gap.cause)) + " before sample " + std::to_string(gap.position);
  if (gap.missing) text += ", " + counted(static_cast<std::size_t>(*gap.missing), "sample") + " missing";
  return text;
}

RecordBuilder gap_record(const Gap& gap) {
  RecordBuilder r("gap");
  r.set("position", gap.position);
  r.set("cause", name_of(gap.cause));
  r.set("missing", gap.missing.value_or(-1));
  return r;
}

void DeviceReport::count(const Gap& gap) {
  ++(gap.cause == GapCause::overrun ? overruns : gap.cause == GapCause::underrun ? underruns : losses);
  missing += gap.missing.value_or(0);
}

std::string DeviceReport::gaps_text() const {
  std::string kinds;
  for (const auto& [count, word] : {std::pair{overruns, "overrun"}, {underruns, "underrun"}, {losses, "loss"}}) {
    if (count == 0) continue;
    kinds += (kinds.empty() ? "" : ", ") + std::to_string(count) + " " + word;
    if (count > 1) kinds += word == std::string("loss") ? "es" : "s";
  }
  return kinds.empty() ? "no gaps" : kinds + ", " + counted(static_cast<std::size_t>(missing), "sample") + " missing";
}

RecordBuilder device_record(const DeviceReport& report, const DeviceClock& clock) {
  RecordBuilder r("device");
  r.set("device", report.device);
  r.set("clock", report.clock);
  r.set("sample_rate", report.rate_hz);
  r.set("measured_rate", clock.rate_hz().value_or(std::numeric_limits<double>::quiet_NaN()));
  r.set("samples", report.samples);
  r.set("overruns", report.overruns);
  r.set("underruns", report.underruns);
  r.set("losses", report.losses);
  r.set("missing", report.missing);
  r.set("clipped", report.clipped);
  r.set("round_trip_delay", report.round_trip_delay);
  r.set("lead", report.lead);
  r.set("period", report.period);
  r.set("buffer", report.buffer);
  const std::uint64_t count = clock.stamps().size();
  auto position = r.array<std::int64_t>("position", "", {count});
  std::transform(clock.stamps().begin(), clock.stamps().end(), position.begin(), [](const TimeStamp& s) { return s.position; });
  auto time = r.array<double>("time", "s", {count});
  std::transform(clock.stamps().begin(), clock.stamps().end(), time.begin(), [](const TimeStamp& s) { return s.time_s; });
  return r;
}

void require_realtime(const Activation& a) {
  if (!a.realtime) fail("a device goes by real time; run: {clock: simulated} does not. Allowed: realtime, hardware");
}

std::string advice_on_calls(const Activation& a) {
  if (!a.rate.known()) return "";
  const double call_s = static_cast<double>(a.max_count) / a.rate.hz();
  if (call_s <= kLongCall_s) return "";
  return "the engine asks for " + short_text(call_s) + " s of samples at once, and Ctrl-C waits for them: set run: {chunk: " +
         std::to_string(std::max<std::int64_t>(1, std::llround(kLongCall_s / 4 * a.rate.hz()))) + "}";
}

void describe_device_ports(Describe& d, MessageOut device, MessageOut gaps) {
  d.message_out(device).record_type("device").doc(
      "at the end: gaps and clipped samples counted, the rate by the clock of the machine, time stamps");
  d.message_out(gaps).record_type("gap").doc("each gap: position of the first sample behind it, cause, samples missing");
}

void describe_on_gap(Describe& d) {
  d.parameter("on_gap", "end")
      .choices({"end", "mark"})
      .doc("what a lost sample does: `end` the run, or go on and `mark` the place by a record on port `gaps`");
}

}  // namespace bodeflow::acquisition
