#include "resample_block.hpp"

#include <cmath>

#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

// What drift may use up where neither the length of the stream nor `buffer` is known.
constexpr double kBuffer_s = 0.1;
constexpr double kMostBuffered = 0x1p24;

/// output / input in lowest terms; up = 0 where that is beyond what a resampler can do.
Rate ratio_of(const Rate& output, const Rate& input) {
  const double up = static_cast<double>(output.num) * static_cast<double>(input.den);
  const double down = static_cast<double>(output.den) * static_cast<double>(input.num);
  if (!(up < 0x1p62) || !(down < 0x1p62)) return {0, 1};
  return {output.num * input.den, output.den * input.num};
}

std::string seconds_text(double samples, const Rate& rate) { return short_text(samples / rate.hz()) + " s"; }

}  // namespace

void Resample::describe(Describe& d) {
  d.id("acquisition.resample")
      .summary("Gives a stream another sample rate, or takes it to another clock.")
      .role("resampler")
      .realtime_safe()
      .cost_ns(100);
  d.doc(
      "Band-limited interpolation, y[m] = sum_n x[n] h(p_m - n) with p_m = (m - delay) (input rate / output rate) (1 + drift) "
      "and a "
      "Kaiser-windowed sinc h: flat up to pass_band of the lower Nyquist frequency (ripple at most 2e-5 for 100 dB), and nothing "
      "folds down from above it. The ratio of the rates is exact. The delay is a whole number of output samples, which `bodeflow "
      "check` tells, so a spectrum is only turned by exp(-j 2 pi f delay / rate). Equal rates without drift pass unchanged. "
      "`drift` "
      "is the known deviation of the input's clock, as seen by the clock of the output; its correction needs a buffer of "
      "drift x length samples, which delays the output where the input runs fast. It is not estimated from the data here.");
  d.reference("R. E. Crochiere, L. R. Rabiner, Multirate Digital Signal Processing, 1983, chapter 2");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
  d.required<double>("rate").unit("Hz").above(0.0).doc("samples per second of the output");
  d.optional<std::string>("clock").doc("clock domain of the output, \"\" for the engine's own; without it that of the input");
  d.parameter("drift", 0.0)
      .unit("ppm")
      .range(-10000, 10000)
      .doc("deviation of the input's true rate from its stated one: 50 where the device gives 1.00005 times as many samples");
  d.optional<double>("buffer").unit("s").range(0, 1e6).doc(
      "what drift may displace in all; by default what the length of the stream needs, 0.1 s where that is not known. The run "
      "ends, with a message, when it is used up");
  d.parameter("pass_band", 0.8).unit("1").range(0.1, 0.98).doc("end of the pass band, of the lower Nyquist frequency");
  d.parameter("attenuation", 100.0).unit("dB").range(21, 160).doc("of images and of what would fold down");
}

void Resample::configure(const Parameters& p) {
  rate_ = Rate::from_hz(p.number("rate"));
  if (!rate_.known()) fail("rate " + number_text(p.number("rate")) + " Hz is beyond what can be kept as a fraction");
  if (p.has("clock")) clock_ = p.text("clock");
  if (p.has("buffer")) buffer_s_ = p.number("buffer");
  spec_.drift = 1e-6 * p.number("drift");
  spec_.pass_band = p.number("pass_band");
  spec_.attenuation_db = p.number("attenuation");
}

/// Input samples by which drift may displace; refused where these are too few for the stream.
std::int64_t Resample::buffer_for(const StreamFacts& x) const {
  const double drift = std::abs(spec_.drift);
  const double needed = x.length < 0 ? kBuffer_s * x.rate.hz() : std::ceil(drift * static_cast<double>(x.length)) + 1.0;
  const double samples = buffer_s_ ? std::floor(*buffer_s_ * x.rate.hz()) : std::ceil(needed);
  if (x.length >= 0 && samples < needed) {
    fail("a drift of " + short_text(1e6 * spec_.drift) + " ppm over " + std::to_string(x.length) + " samples needs a buffer of " +
         seconds_text(needed, x.rate) + "; buffer gives " + seconds_text(samples, x.rate));
  }
  if (samples > kMostBuffered) fail("a buffer of " + short_text(samples) + " samples; at most 16777216");
  return static_cast<std::int64_t>(samples);
}

void Resample::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  const Rate ratio = ratio_of(rate_, x.rate);
  if (!ratio.known())
    fail("the ratio of the output rate " + number_text(rate_.hz()) + " Hz to the input rate " + number_text(x.rate.hz()) +
         " Hz is beyond 64 bits; choose a rate in a simpler ratio");
  ResamplerSpec spec = spec_;
  spec.up = ratio.num;
  spec.down = ratio.den;
  if (std::abs(spec.drift) > 0.0) spec.buffer = buffer_for(x);
  const auto plan = plan_resampler(spec);
  if (!plan) fail(plan.error().text);
  plan_ = *plan;
  channels_ = x.channels;
  input_rate_ = x.rate;
  f.samples(in, spec.down);
  f.samples(out, spec.up);
  StreamFacts& y = f.out(out);
  y.rate = rate_;
  if (clock_) y.clock = *clock_;
  if (y.length >= 0) y.length = y.length / spec.down * spec.up;
  if (!plan_.is_wire()) y.notes.erase("noise.std");  // the filter colours noise
}

void Resample::advise(const Facts& f, Advice& a) {
  if (plan_.is_wire()) return;
  a.tell("delays by " + std::to_string(plan_.delay) + " output samples, " +
         seconds_text(static_cast<double>(plan_.delay), rate_));
  if (std::abs(plan_.spec.drift) > 0.0 && f.in(in).length < 0) {
    a.tell("the length of the input is not known: the buffer lasts for " +
           seconds_text(static_cast<double>(plan_.spec.buffer) / std::abs(plan_.spec.drift), input_rate_) +
           ", then the run ends; `buffer` makes it longer");
  }
  const double edge = plan_.spec.pass_band * 0.5 * std::min(rate_.hz(), input_rate_.hz());
  for (const double line : f.in(in).note("excitation.frequencies")) {
    if (line <= edge) continue;
    a.warn("the excitation has lines above " + short_text(edge) +
           " Hz, the end of the pass band: these are attenuated; raise rate or "
           "pass_band, or excite lower lines");
    return;
  }
}

void Resample::activate(const Activation& a) { resampler_.emplace(plan_, channels_, static_cast<std::int64_t>(a.max_count)); }

void Resample::process(Io& io) {
  const auto first = static_cast<std::int64_t>(io.position());
  for (int c = 0; c < channels_; ++c) {
    if (resampler_->run(c, first, io.read(in, c), io.write(out, c))) continue;
    fail("the buffer of " + std::to_string(plan_.spec.buffer) + " samples (" +
         seconds_text(static_cast<double>(plan_.spec.buffer), input_rate_) + ") is used up: a drift of " +
         short_text(1e6 * plan_.spec.drift) + " ppm uses it in " +
         seconds_text(static_cast<double>(plan_.spec.buffer) / std::abs(plan_.spec.drift), input_rate_) + "; raise buffer");
  }
}

void Resample::reset() { resampler_->reset(); }

}  // namespace bodeflow::acquisition
