#include "playback_block.hpp"

#include <algorithm>

#include "playing.hpp"

namespace bodeflow::acquisition {

void AlsaPlayback::describe(Describe& d) {
  d.id("acquisition.alsa_playback")
      .summary("Gives samples out through a sound device by ALSA.")
      .role("device")
      .role("actuator")
      .cost_ns(200);
  d.doc(
      "Begins with `lead` samples of silence and blocks while the device's buffer is full: it paces the run. Values are divided "
      "by "
      "the scale, rounded to the codes of the format and limited to full scale; limited samples are counted. An underrun ends "
      "the run "
      "or is marked (`on_gap`); behind it comes the silence again. The end of the run waits until all was played; an error or "
      "Ctrl-C "
      "ends the output at once. To measure a response use acquisition.alsa_duplex.");
  d.stream_in(in).doc("a channel of the device for each channel; on the engine's clock or the device's own");
  describe_device_ports(d, device, gaps);
  describe_card(d);
  describe_lead(d);
  describe_scale(d, "", "full scale of the converter");
}

void AlsaPlayback::configure(const Parameters& p) {
  card_ = read_card(p);
  card_.spec.direction = Direction::playback;
  scale_ = read_scale(p, "");
  lead_asked_ = read_lead(p, card_.spec);
  if (!scale_.calibration.empty()) note_input(scale_.calibration);
}

void AlsaPlayback::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  rate_ = x.rate;
  card_.spec.rate_hz = whole_rate(x.rate);
  card_.spec.channels = static_cast<unsigned>(x.channels);
  channels_ = make_channels(scale_, numbered_channels(x.channels));
  check_played(x, channels_, card_.clock);
}

void AlsaPlayback::advise(const Facts& f, Advice& a) { advise_on_level(f.in(in), channels_, a); }

void AlsaPlayback::activate(const Activation& a) {
  require_realtime(a);
  if (const std::string advice = advice_on_calls(a); !advice.empty()) log_warning(advice);
  auto opened = Pcm::open(card_.spec);
  if (!opened) fail(opened.error().text);
  pcm_.emplace(std::move(*opened));
  const PcmSpec& spec = pcm_->spec();
  lead_ = lead_asked_.value_or(spec.buffer - spec.period);
  bytes_.resize(std::max(lead_, spec.period) * pcm_->frame_bytes());
  reset();
}

void AlsaPlayback::reset() {
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
  report_.lead = static_cast<std::int64_t>(lead_);
  report_.period = static_cast<std::int64_t>(pcm_->spec().period);
  report_.buffer = static_cast<std::int64_t>(pcm_->spec().buffer);
}

void AlsaPlayback::begin() {
  if (auto done = pcm_->prepare(); !done) fail(done.error().text);
  std::fill(bytes_.begin(), bytes_.end(), std::uint8_t{0});
  if (const auto silence = pcm_->write(bytes_.data(), lead_); !silence) fail(silence.error().text);
  if (auto done = pcm_->start(); !done) fail(done.error().text);
  running_ = true;
}

void AlsaPlayback::process(Io& io) {
  if (!running_) begin();
  const std::size_t period = pcm_->spec().period;
  for (std::size_t done = 0; done < io.count();) {
    const std::size_t wanted = std::min(period, io.count() - done);
    encode_all(wanted, done, io);
    const auto moved = pcm_->write(bytes_.data(), wanted);
    if (!moved) fail(moved.error().text);
    done += moved->frames;
    breaks_.moved(moved->frames);
    if (moved->broken) break_off(io, done);
  }
  if (auto stamp = pcm_->stamp()) {
    stamp->position += base_ - static_cast<std::int64_t>(lead_);
    clock_.add(*stamp);
  }
  report_.samples += static_cast<std::int64_t>(io.count());
}

void AlsaPlayback::encode_all(std::size_t frames, std::size_t offset, Io& io) {
  for (std::size_t c = 0; c < channels_.names.size(); ++c) {
    const auto values = io.read(in, static_cast<int>(c)).subspan(offset, frames);
    require_finite(values, io.position() + offset, static_cast<int>(c));
    const Interleaved layout{card_.spec.format, channels_.names.size(), c};
    report_.clipped += static_cast<std::int64_t>(encode(layout, channels_.scales[c], values, bytes_.data()));
  }
}

void AlsaPlayback::break_off(Io& io, std::size_t offset) {
  Gap gap;
  gap.position = static_cast<std::int64_t>(io.position() + offset);
  gap.cause = GapCause::underrun;
  if (!card_.mark_gaps)
    fail(text_of(gap) + ": the device was not fed in time; raise lead and buffer, or set on_gap: mark to go on");
  begin();
  const TimeStamp next{gap.position, pcm_->started_s() + static_cast<double>(lead_) / rate_.hz()};  // behind the silence
  gap.missing = samples_missing(clock_, next, rate_);
  breaks_.broke();
  report_.count(gap);
  log_warning(text_of(gap));
  io.emit(gaps, gap_record(gap), offset);
  clock_.start_anew(next);
  base_ = gap.position;
}

void AlsaPlayback::finish(Io& io) {
  if (running_) {
    if (auto done = pcm_->play_out(); !done) fail(done.error().text);
  }
  log_info(report_.gaps_text() + "; " + std::to_string(report_.clipped) + " samples limited to full scale");
  io.emit(device, device_record(report_, clock_));
}

void AlsaPlayback::deactivate() {
  if (pcm_) pcm_->drop();
  pcm_.reset();
}

}  // namespace bodeflow::acquisition
