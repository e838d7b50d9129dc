#include "nco_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "phase.hpp"
#include "source.hpp"

namespace bodeflow::generators {

void Nco::describe(Describe& d) {
  d.id("generators.nco")
      .summary("Gives a sine as a numerically controlled oscillator makes it (direct digital synthesis).")
      .role("source")
      .realtime_safe()
      .cost_ns(3);
  d.doc(
      "A phase accumulator of B bits grows by the tuning word W = round(2^B frequency / sample_rate) each sample; its upper T "
      "bits address a "
      "table of one turn of a sine in words of A bits. The frequency is a multiple of sample_rate / 2^B. Spurious-free range: "
      "dropping B - T "
      "phase bits leaves spurs at least 6.02 T - 3.92 dB below the sine (Nicholas & Samueli 1987), 68.3 dB with 12 bits; the "
      "rounding of the words adds noise "
      "of 6.02 A + 1.76 dB below it. With `dither` a seeded random number is added to the phase bits that are dropped: the "
      "spurs become white noise of about the same power. For an exact sine take generators.sine.");
  d.reference(
      "H. T. Nicholas, H. Samueli, An analysis of the output spectrum of direct digital frequency synthesizers in the presence "
      "of "
      "phase-accumulator truncation, 1987");
  describe_source(d);
  d.required<double>("frequency")
      .unit("Hz")
      .range(0, kMaxRateHz)
      .live()
      .doc("at most half of the sample rate; a change keeps the phase");
  d.parameter("accumulator_bits", std::int64_t{32}).range(2, 48).doc("B, bits of the phase accumulator");
  d.parameter("table_bits", std::int64_t{12}).range(1, 20).doc("T, bits that address the table; at most B");
  d.parameter("amplitude_bits", std::int64_t{16}).range(2, 32).doc("A, bits of the table's words, sign counted");
  d.parameter("dither", false).doc("dither the phase");
  d.parameter("amplitude", 1.0).unit("").live().doc("peak value");
  d.parameter("offset", 0.0).unit("").live().doc("mean value");
  d.parameter("phase", 0.0).unit("rad").range(-7, 7).doc("phase of the first sample");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the dither; without it the run's seed and the block's name do");
  d.stream_out(out).doc("one channel");
}

void Nco::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  start_phase_ = p.number("phase");
  dither_ = p.boolean("dither");
  own_seed_ = p.has("seed");
  seed_ = own_seed_ ? static_cast<std::uint64_t>(p.integer("seed")) : 0;
  accumulator_bits_ = static_cast<int>(whole(p, "accumulator_bits", 2, 48));
  const OscillatorBits bits{accumulator_bits_, static_cast<int>(whole(p, "table_bits", 1, std::min(accumulator_bits_, 20))),
                            static_cast<int>(whole(p, "amplitude_bits", 2, 32))};
  oscillator_.emplace(bits);
  change(p);
}

void Nco::resolve(Facts& f) { f.out(out) = source_facts(rate_, unit_); }

void Nco::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  reset();
  char text[100];
  std::snprintf(text, sizeof text, "tuning word %llu, frequency %.12g Hz", static_cast<unsigned long long>(word_),
                std::ldexp(static_cast<double>(word_), -accumulator_bits_) * rate_.hz());
  log_info(text);
}

void Nco::process(Io& io) {
  const double amplitude = amplitude_, offset = offset_;
  const auto y = io.write(out);
  if (dither_) {
    for (double& value : y) value = offset + amplitude * oscillator_->next(random_);
  } else {
    for (double& value : y) value = offset + amplitude * oscillator_->next();
  }
}

void Nco::change(const Parameters& p) {
  const double frequency = p.number("frequency");
  if (!(frequency >= 0 && frequency <= 0.5 * rate_.hz()))
    fail("frequency is " + hertz(frequency) + ", allowed: at most half of the sample rate, " + hertz(0.5 * rate_.hz()));
  amplitude_ = p.number("amplitude");
  offset_ = p.number("offset");
  word_ = oscillator_->word_of(Phase::step(frequency, rate_).fraction64());
  oscillator_->tune(word_);
}

void Nco::reset() {
  oscillator_->start(Phase::from_radians(start_phase_).fraction64());
  random_ = numerics::Random(seed_);
}

}  // namespace bodeflow::generators
