#include "capture_block.hpp"

#include <algorithm>

namespace bodeflow::acquisition {

void AlsaCapture::describe(Describe& d) {
  d.id("acquisition.alsa_capture")
      .summary("Takes samples from a sound device through ALSA.")
      .role("source")
      .role("device")
      .cost_ns(200);
  d.doc(
      "Blocks until the device has given the samples of a call; it paces the run. Nothing is resampled or converted on the way: "
      "a device that has not the rate, format or channels asked for refuses the run. Full scale of the converter reads as +-1; "
      "`scale` or `calibration` makes physical values of it. An overrun ends the run or is marked (`on_gap`); the samples behind "
      "it "
      "follow directly. To measure a response use acquisition.alsa_duplex: two devices that start apart have no common time.");
  d.stream_out(out).doc("the channels of the device, on its own clock");
  describe_device_ports(d, device, gaps);
  describe_card(d);
  d.required<double>("rate").unit("Hz").above(0.0).doc("frames per second, a whole number");
  d.parameter("channels", std::int64_t{1}).range(1, 1024).doc("of the device; named ch1, ch2 ...");
  describe_scale(d, "", "full scale of the converter");
  describe_ac_corner(d);
}

void AlsaCapture::configure(const Parameters& p) {
  card_ = read_card(p);
  rate_ = Rate::from_hz(p.number("rate"));
  card_.spec.rate_hz = whole_rate(rate_);
  card_.spec.channels = static_cast<unsigned>(p.integer("channels"));
  channels_ = make_channels(read_scale(p, ""), numbered_channels(static_cast<int>(card_.spec.channels)));
  if (!channels_.calibration.empty()) note_input(channels_.calibration);
  if (p.has("ac_corner")) ac_corner_hz_ = p.number("ac_corner");
}

void AlsaCapture::resolve(Facts& f) {
  StreamFacts& y = f.out(out);
  y.known = true;
  y.rate = rate_;
  y.clock = card_.clock;
  channels_.state(y);
  note_ac_corner(ac_corner_hz_, y);
}

void AlsaCapture::activate(const Activation& a) {
  require_realtime(a);
  if (const std::string advice = advice_on_calls(a); !advice.empty()) log_warning(advice);
  auto opened = Pcm::open(card_.spec);
  if (!opened) fail(opened.error().text);
  pcm_.emplace(std::move(*opened));
  bytes_.resize(pcm_->spec().period * pcm_->frame_bytes());
  reset();
}

void AlsaCapture::reset() {
  running_ = false;
  base_ = 0;
  breaks_ = BreakCounter();
  clock_.reset();
  report_ = DeviceReport();
  report_.device = card_.spec.device;
  report_.clock = card_.clock;
  report_.rate_hz = rate_.hz();
  if (!pcm_) return;
  pcm_->drop();
  report_.period = static_cast<std::int64_t>(pcm_->spec().period);
  report_.buffer = static_cast<std::int64_t>(pcm_->spec().buffer);
}

void AlsaCapture::begin() {
  if (auto done = pcm_->prepare(); !done) fail(done.error().text);
  if (auto done = pcm_->start(); !done) fail(done.error().text);
  running_ = true;
}

void AlsaCapture::process(Io& io) {
  if (!running_) begin();
  const std::size_t period = pcm_->spec().period;
  for (std::size_t done = 0; done < io.count();) {
    const auto moved = pcm_->read(bytes_.data(), std::min(period, io.count() - done));
    if (!moved) fail(moved.error().text);
    decode_all(moved->frames, done, io);
    done += moved->frames;
    breaks_.moved(moved->frames);
    if (moved->broken) break_off(io, done);
  }
  if (auto stamp = pcm_->stamp()) {
    stamp->position += base_;
    clock_.add(*stamp);
  }
  report_.samples += static_cast<std::int64_t>(io.count());
}

void AlsaCapture::decode_all(std::size_t frames, std::size_t offset, Io& io) {
  for (std::size_t c = 0; c < channels_.names.size(); ++c) {
    const Interleaved layout{card_.spec.format, channels_.names.size(), c};
    const auto values = io.write(out, static_cast<int>(c)).subspan(offset, frames);
    report_.clipped += static_cast<std::int64_t>(decode(layout, channels_.scales[c], bytes_.data(), values));
  }
}

void AlsaCapture::break_off(Io& io, std::size_t offset) {
  Gap gap;
  gap.position = static_cast<std::int64_t>(io.position() + offset);
  gap.cause = GapCause::overrun;
  if (!card_.mark_gaps)
    fail(text_of(gap) + ": the samples were not taken in time; raise buffer or run.chunk, or set on_gap: mark to go on");
  begin();
  const TimeStamp next{gap.position, pcm_->started_s()};
  gap.missing = samples_missing(clock_, next, rate_);
  breaks_.broke();
  report_.count(gap);
  log_warning(text_of(gap));
  io.emit(gaps, gap_record(gap), offset);
  clock_.start_anew(next);
  base_ = gap.position;
}

void AlsaCapture::finish(Io& io) {
  if (pcm_) pcm_->drop();
  log_info(report_.gaps_text() + "; " + std::to_string(report_.clipped) + " samples at full scale");
  io.emit(device, device_record(report_, clock_));
}

void AlsaCapture::deactivate() { pcm_.reset(); }

}  // namespace bodeflow::acquisition
