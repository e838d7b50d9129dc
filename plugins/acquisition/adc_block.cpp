#include "adc_block.hpp"

#include <algorithm>
#include <bodeflow/numerics/discretise.hpp>
#include <cmath>
#include <numbers>

#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

// A line that the anti-alias filter weakens more than this is not worth a warning.
constexpr double kWeak_dB = 80.0;

std::string with_unit(double value, const std::string& unit) { return short_text(value) + (unit.empty() ? "" : " " + unit); }

}  // namespace

void Adc::describe(Describe& d) {
  d.id("acquisition.adc")
      .summary("Models an analog-to-digital converter: anti-alias filter, aperture jitter, errors, clipping, rounding.")
      .realtime_safe()
      .cost_ns(200);
  d.doc(
      "The input comes `factor` times as fast as the output. It is taken as held over each of its sampling intervals and goes "
      "through "
      "a Butterworth filter, simulated exactly; every factor-th value is converted, with jitter at an instant displaced by a "
      "normal "
      "deviate (the same for all channels; a cubic through the four samples around it, so the input should be at least 8 times "
      "as "
      "fast as its highest frequency is). Then v' = (1 + gain_error) v + offset_error is rounded to the levels low + code LSB, "
      "LSB = "
      "(high - low) / 2^bits, code 0 to 2^bits - 1 (mid-tread). Rounding adds noise of LSB^2 / 12 as long as the signal moves by "
      "several LSB from sample to sample: 6.02 bits + 1.76 dB below a full-scale sine; jitter sigma limits a sine of frequency f "
      "to "
      "-20 log10(2 pi f sigma) dB. Clipped samples are counted and told at the end.");
  d.reference("IEEE Std 1241-2010, Terminology and Test Methods for Analog-to-Digital Converters");
  d.stream_in(in).doc("the analog signal, `factor` times as fast as the output");
  d.stream_out(out).same_as(in);
  d.required<std::int64_t>("factor").range(1, 1 << 16).doc("input samples for each output sample");
  d.required<std::vector<double>>("range").unit("").doc(
      "lowest and highest value that can be converted, in the unit of the input");
  d.optional<std::int64_t>("bits").range(1, 32).doc("without it values are clipped, but not rounded");
  d.parameter("filter.order", std::int64_t{0}).range(0, 12).doc("of the Butterworth anti-alias filter; 0: none");
  d.optional<double>("filter.corner").unit("Hz").above(0.0).doc("its -3 dB frequency");
  d.parameter("jitter", 0.0)
      .unit("s")
      .range(0, 1)
      .doc("standard deviation of the sampling instants; needs a factor of 4 or more");
  d.parameter("gain_error", 0.0).unit("1").range(-1, 1e6).doc("relative");
  d.parameter("offset_error", 0.0).unit("").doc("in the unit of the input");
  d.parameter("missing_codes", std::vector<std::int64_t>{}).doc("codes that never occur; those beside them take their place");
  d.parameter("nonlinearity", std::vector<double>{})
      .unit("")
      .doc("integral nonlinearity in LSB at equally spaced points over the range, straight between them");
}

void Adc::configure(const Parameters& p) {
  factor_ = p.integer("factor");
  const std::vector<double>& range = p.numbers("range");
  if (range.size() != 2) fail("range has " + std::to_string(range.size()) + " values; allowed: two, lowest and highest");
  spec_.low = range[0];
  spec_.high = range[1];
  if (p.has("bits")) spec_.bits = static_cast<int>(p.integer("bits"));
  spec_.gain_error = p.number("gain_error");
  spec_.offset_error = p.number("offset_error");
  spec_.missing_codes = p.integers("missing_codes");
  spec_.nonlinearity_lsb = p.numbers("nonlinearity");
  auto quantiser = Quantiser::make(spec_);
  if (!quantiser) fail(quantiser.error().text);
  quantiser_ = std::move(*quantiser);
  order_ = static_cast<int>(p.integer("filter.order"));
  if (order_ > 0 && !p.has("filter.corner")) fail("filter.order without filter.corner, its -3 dB frequency");
  if (order_ == 0 && p.has("filter.corner")) fail("filter.corner without filter.order; allowed: 1 to 12");
  if (order_ > 0) corner_hz_ = p.number("filter.corner");
  jitter_s_ = p.number("jitter");
}

void Adc::resolve(Facts& f) {
  f.samples(in, factor_);
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  channels_ = x.channels;
  input_rate_ = x.rate;
  unit_ = x.unit;
  if (corner_hz_ >= 0.5 * x.rate.hz())
    fail("filter.corner " + short_text(corner_hz_) + " Hz; below half the input rate, " + short_text(0.5 * x.rate.hz()) + " Hz");
  const double most = std::max(0.0, static_cast<double>(factor_ - 3)) / (kLargestDeviate * x.rate.hz());
  if (jitter_s_ > most)
    fail("jitter " + short_text(jitter_s_) + " s with factor " + std::to_string(factor_) + " at an input rate of " +
         short_text(x.rate.hz()) + " Hz; at most (factor - 3) / 8.3 input intervals, " + short_text(most) + " s");
  StreamFacts& y = f.out(out);
  y.rate = y.rate.scaled(1, factor_);
  if (y.length >= 0) y.length /= factor_;
  const bool noisy = y.notes.count("noise.std") != 0;
  if (order_ > 0) y.notes.erase("noise.std");  // filtered noise is not white
  if (quantiser_->step() > 0.0 && !(noisy && order_ > 0)) {
    std::vector<double>& noise = y.notes["noise.std"];
    if (noise.empty()) noise = {0.0};
    for (double& std : noise) std = std::hypot(std, quantiser_->step() / std::sqrt(12.0));
  }
}

double Adc::attenuation_db(double frequency_hz) const {
  return order_ == 0 ? 0.0 : 10 * std::log10(1 + std::pow(frequency_hz / corner_hz_, 2 * order_));
}

void Adc::advise(const Facts& f, Advice& a) {
  const double step = quantiser_->step();
  if (step > 0.0)
    a.tell("LSB " + with_unit(step, unit_) + ", rounding noise " + with_unit(step / std::sqrt(12.0), unit_) + " rms");
  const std::vector<double> lines = f.in(in).note("excitation.frequencies");
  const double rate = f.out(out).rate.hz();
  if (jitter_s_ > 0.0 && !lines.empty()) {
    a.tell("jitter limits a line at " + short_text(lines.back()) + " Hz to " +
           short_text(-20 * std::log10(2 * std::numbers::pi * lines.back() * jitter_s_)) + " dB above its noise");
  }
  for (const double line : lines) {
    if (line < 0.5 * rate || attenuation_db(line) > kWeak_dB) continue;
    const double folded = std::abs(line - rate * std::round(line / rate));
    a.warn("the line at " + short_text(line) + " Hz is above half the output rate and folds down to " + short_text(folded) +
           " Hz, weakened by " + short_text(attenuation_db(line)) +
           " dB; set filter.order and filter.corner, or excite lower lines");
    return;
  }
}

void Adc::activate(const Activation& a) {
  const auto outputs = static_cast<std::size_t>(a.max_count), factor = static_cast<std::size_t>(factor_);
  std::optional<AnalogFilter> filter;
  if (order_ > 0) {
    const auto analog = butterworth(order_, corner_hz_);
    if (!analog) fail(analog.error().text);
    auto discrete = numerics::zero_order_hold(*analog, 1.0 / input_rate_.hz());
    if (!discrete) fail("anti-alias filter: " + discrete.error().text);
    filter.emplace(std::move(discrete->model));
  }
  state_.assign(static_cast<std::size_t>(channels_), Channel{filter, ApertureSampler(factor, outputs)});
  filtered_.resize(order_ > 0 ? outputs * factor : 0);
  displacement_.resize(jitter_s_ > 0.0 ? outputs : 0);
  seed_ = a.seed;
  reset();
}

void Adc::reset() {
  random_ = numerics::Random(seed_);
  for (Channel& channel : state_) {
    if (channel.filter) channel.filter->reset();
    channel.sampler.reset();
  }
  samples_ = clipped_ = 0;
}

void Adc::check_finite(std::span<const double> x, int channel, std::uint64_t first) const {
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (std::isfinite(x[n])) continue;
    fail("sample " + std::to_string(first + n) + " of channel " + std::to_string(channel + 1) + " is " + number_text(x[n]) +
         "; a converter takes finite values");
  }
}

void Adc::count_clipped(int channel, std::uint64_t sample) {
  if (clipped_++ > 0 && sample >= first_clipped_) return;
  first_clipped_ = sample;
  first_clipped_channel_ = channel;
}

void Adc::process(Io& io) {
  const auto factor = static_cast<std::uint64_t>(factor_);
  const std::span<double> displacement(displacement_.data(), jitter_s_ > 0.0 ? io.count() : 0);
  for (double& d : displacement) d = random_.normal() * jitter_s_ * input_rate_.hz();
  for (int c = 0; c < channels_; ++c) {
    Channel& channel = state_[static_cast<std::size_t>(c)];
    std::span<const double> x = io.read(in, c);
    const std::span<double> y = io.write(out, c);
    check_finite(x, c, io.position() * factor);
    if (channel.filter) {
      channel.filter->run(x, {filtered_.data(), x.size()});
      x = {filtered_.data(), x.size()};
    }
    channel.sampler.run(x, displacement, y);
    for (std::size_t m = 0; m < y.size(); ++m) {
      const Converted converted = quantiser_->convert(y[m]);
      y[m] = converted.value;
      if (converted.clipped) count_clipped(c, io.position() + m);
    }
  }
  samples_ += io.count() * static_cast<std::uint64_t>(channels_);
}

void Adc::finish(Io&) {
  if (clipped_ == 0) return;
  log_warning("clipped " + std::to_string(clipped_) + " of " + std::to_string(samples_) + " samples (" +
              short_text(100.0 * static_cast<double>(clipped_) / static_cast<double>(samples_)) + " %), the first at sample " +
              std::to_string(first_clipped_) + " of channel " + std::to_string(first_clipped_channel_ + 1) + "; range " +
              short_text(spec_.low) + " to " + with_unit(spec_.high, unit_) + ": widen it or lower the signal");
}

}  // namespace bodeflow::acquisition
