#include "duplex_block.hpp"

#include <algorithm>

#include "acquisition/sampling.hpp"
#include "playing.hpp"

namespace bodeflow::acquisition {
namespace {

// A first-order coupling at ten times its corner: -0.04 dB, 5.7 deg.
constexpr double kClearOfCorner = 10.0;

}  // namespace

void AlsaDuplex::describe(Describe& d) {
  d.id("acquisition.alsa_duplex")
      .summary("Plays and captures on one sound card through ALSA, sample by sample together.")
      .role("device")
      .role("actuator")
      .role("resampler")
      .cost_ns(400);
  d.doc(
      "`played` is what the converter was given: the input rounded to the codes of the format, `lead` samples late, on the clock "
      "of "
      "the card. `captured` is what the card took at the same samples, less `round_trip_delay`, the delay of converters and "
      "drivers "
      "as measured with the output connected to the input. Sample n of `captured` is the answer to sample n of `played`: take "
      "the "
      "response between these two. The block waits for the card and paces the run. Both directions start together where the "
      "driver "
      "links them; where it does not, a warning says so, and the delay holds for one run alone. Behind an overrun or underrun "
      "both "
      "start again with what was not played yet: `played` and `captured` stay together, time has gone by between two samples.");
  d.stream_in(in).doc("a channel of the card for each channel; on the engine's clock or the card's own");
  d.stream_out(played).same_as(in).doc("what the card gave out, on its clock");
  d.stream_out(captured).doc("what the card took at the same time, on its clock");
  describe_device_ports(d, device, gaps);
  describe_card(d);
  d.optional<std::string>("capture.device").doc("the device that captures, where it has another name than the one that plays");
  d.parameter("capture.channels", std::int64_t{1}).range(1, 1024).doc("channels to capture; named ch1, ch2 ...");
  describe_scale(d, "capture.", "full scale of the input's converter");
  describe_scale(d, "playback.", "full scale of the output's converter");
  describe_lead(d);
  d.parameter("round_trip_delay", std::int64_t{0})
      .range(0, 1 << 20)
      .doc("samples from converter to converter as measured; so many are left out of `captured` at the start");
  describe_ac_corner(d);
}

void AlsaDuplex::configure(const Parameters& p) {
  card_ = read_card(p);
  capture_device_ = p.has("capture.device") ? p.text("capture.device") : card_.spec.device;
  lead_asked_ = read_lead(p, card_.spec);
  round_trip_ = static_cast<std::size_t>(p.integer("round_trip_delay"));
  play_scale_ = read_scale(p, "playback.");
  capture_ = make_channels(read_scale(p, "capture."), numbered_channels(static_cast<int>(p.integer("capture.channels"))));
  if (p.has("ac_corner")) ac_corner_hz_ = p.number("ac_corner");
  for (const std::string& file : {play_scale_.calibration, capture_.calibration})
    if (!file.empty()) note_input(file);
}

void AlsaDuplex::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  rate_ = x.rate;
  card_.spec.rate_hz = whole_rate(x.rate);
  play_ = make_channels(play_scale_, numbered_channels(x.channels));
  check_played(x, play_, card_.clock);
  StreamFacts& u = f.out(played);
  u.clock = card_.clock;
  if (u.unit.empty() && u.channel_units.empty()) u.unit = play_.unit();
  StreamFacts& y = f.out(captured);
  y.known = true;
  y.rate = x.rate;
  y.length = x.length;
  y.clock = card_.clock;
  capture_.state(y);
  note_ac_corner(ac_corner_hz_, y);
}

void AlsaDuplex::advise(const Facts& f, Advice& a) {
  advise_on_level(f.in(in), play_, a);
  a.tell("the output leads by " +
         (lead_asked_ ? std::to_string(*lead_asked_)
                      : "the device's buffer less a period, about " + std::to_string(card_.spec.buffer - card_.spec.period)) +
         " samples: let the first periods pass (skip) until what is played is steady");
  if (!ac_corner_hz_) return;
  for (const double line : f.in(in).note("excitation.frequencies")) {
    if (line >= kClearOfCorner * *ac_corner_hz_) continue;
    a.warn("the line at " + short_text(line) + " Hz lies below ten times the corner of the AC coupling, " +
           short_text(*ac_corner_hz_) + " Hz: its phase is turned by the coupling; leave lines below " +
           short_text(kClearOfCorner * *ac_corner_hz_) + " Hz out");
    return;
  }
}

Pcm AlsaDuplex::open(Direction direction, std::size_t channels) const {
  PcmSpec spec = card_.spec;
  spec.direction = direction;
  spec.channels = static_cast<unsigned>(channels);
  if (direction == Direction::capture) spec.device = capture_device_;
  auto opened = Pcm::open(spec);
  if (!opened) fail(opened.error().text);
  return std::move(*opened);
}

void AlsaDuplex::activate(const Activation& a) {
  require_realtime(a);
  if (const std::string advice = advice_on_calls(a); !advice.empty()) log_warning(advice);
  Pcm playback = open(Direction::playback, play_.names.size());
  Pcm capture = open(Direction::capture, capture_.names.size());
  const std::size_t most = playback.spec().buffer - playback.spec().period;
  auto made = Duplex::make(std::move(playback), std::move(capture), lead_asked_.value_or(most), round_trip_);
  if (!made) fail(made.error().text);
  duplex_.emplace(std::move(*made));
  if (!duplex_->linked())
    log_warning("playback and capture of '" + card_.spec.device +
                "' can't be linked: they start one after the other, and a "
                "round_trip_delay measured in one run may not hold in the next");
  const std::size_t period = duplex_->playback().spec().period;
  to_play_.resize(period * duplex_->playback().frame_bytes());
  played_.resize(to_play_.size());
  captured_.resize(period * duplex_->capture().frame_bytes());
  reset();
}

void AlsaDuplex::reset() {
  base_ = 0;
  breaks_ = BreakCounter();
  clock_.reset();
  report_ = DeviceReport();
  report_.device = card_.spec.device;
  report_.clock = card_.clock;
  report_.rate_hz = rate_.hz();
  report_.round_trip_delay = static_cast<std::int64_t>(round_trip_);
  if (!duplex_) return;
  duplex_->reset();
  report_.lead = static_cast<std::int64_t>(duplex_->lead());
  report_.period = static_cast<std::int64_t>(duplex_->playback().spec().period);
  report_.buffer = static_cast<std::int64_t>(duplex_->playback().spec().buffer);
}

void AlsaDuplex::process(Io& io) {
  const std::size_t period = duplex_->playback().spec().period;
  for (std::size_t done = 0; done < io.count();) {
    std::size_t left = std::min(period, io.count() - done);
    encode_all(left, done, io);
    auto moved = duplex_->step(to_play_.data(), left, played_.data(), captured_.data());
    while (true) {
      if (!moved) fail(moved.error().text);
      decode_all(moved->frames, done, io);
      done += moved->frames;
      left -= moved->frames;
      breaks_.moved(moved->frames);
      if (!moved->broken) break;
      break_off(moved->underrun, done, io);
      moved = duplex_->resume(left, played_.data(), captured_.data());
    }
  }
  if (auto stamp = duplex_->capture().stamp()) {
    stamp->position += base_ - static_cast<std::int64_t>(round_trip_);
    clock_.add(*stamp);
  }
  report_.samples += static_cast<std::int64_t>(io.count());
}

void AlsaDuplex::encode_all(std::size_t frames, std::size_t offset, Io& io) {
  for (std::size_t c = 0; c < play_.names.size(); ++c) {
    const auto values = io.read(in, static_cast<int>(c)).subspan(offset, frames);
    require_finite(values, io.position() + offset, static_cast<int>(c));
    const Interleaved layout{card_.spec.format, play_.names.size(), c};
    report_.clipped += static_cast<std::int64_t>(encode(layout, play_.scales[c], values, to_play_.data()));
  }
}

void AlsaDuplex::decode_all(std::size_t frames, std::size_t offset, Io& io) {
  for (std::size_t c = 0; c < play_.names.size(); ++c) {
    const Interleaved layout{card_.spec.format, play_.names.size(), c};
    decode(layout, play_.scales[c], played_.data(), io.write(played, static_cast<int>(c)).subspan(offset, frames));
  }
  for (std::size_t c = 0; c < capture_.names.size(); ++c) {
    const Interleaved layout{card_.spec.format, capture_.names.size(), c};
    const auto values = io.write(captured, static_cast<int>(c)).subspan(offset, frames);
    report_.clipped += static_cast<std::int64_t>(decode(layout, capture_.scales[c], captured_.data(), values));
  }
}

void AlsaDuplex::break_off(bool underrun, std::size_t offset, Io& io) {
  Gap gap;
  gap.position = static_cast<std::int64_t>(io.position() + offset);
  gap.cause = underrun ? GapCause::underrun : GapCause::overrun;
  if (!card_.mark_gaps)
    fail(text_of(gap) + ": the card was not served in time; raise lead and buffer, or set on_gap: mark to go on");
  while (true) {
    breaks_.broke();
    const auto running = duplex_->restart();
    if (!running) fail(running.error().text);
    const TimeStamp next{gap.position, duplex_->capture().started_s() + static_cast<double>(round_trip_) / rate_.hz()};
    gap.missing = samples_missing(clock_, next, rate_);
    report_.count(gap);
    log_warning(text_of(gap));
    io.emit(gaps, gap_record(gap), offset);
    clock_.start_anew(next);
    base_ = gap.position;
    if (*running) return;
    gap.cause = GapCause::overrun;
  }
}

void AlsaDuplex::finish(Io& io) {
  if (duplex_) duplex_->drop();
  log_info(report_.gaps_text() + "; " + std::to_string(report_.clipped) +
           " samples at full scale; round-trip delay taken out: " + std::to_string(round_trip_) + " samples");
  io.emit(device, device_record(report_, clock_));
}

void AlsaDuplex::deactivate() {
  if (duplex_) duplex_->drop();
  duplex_.reset();
}

}  // namespace bodeflow::acquisition
