#include "square_block.hpp"

#include <algorithm>
#include <cmath>

#include "period_notes.hpp"
#include "source.hpp"

namespace bodeflow::generators {

void Square::describe(Describe& d) {
  d.id("generators.square").summary("Gives a square wave of exact frequency.").role("source").realtime_safe().cost_ns(2);
  d.doc(
      "y[n] = offset + amplitude where the phase of sample n is in the first `duty` of its cycle, offset - amplitude elsewhere. "
      "With "
      "`frequency` the ideal square wave is sampled: its mean frequency is exact, but where a cycle has no whole number of "
      "samples the edges "
      "jump by one sample, and harmonics above half of the sample rate fold back between the lines. With `period`, in samples, "
      "every cycle is "
      "the same: a discrete-interval signal whose spectrum has lines at multiples of sample_rate / period only.");
  describe_source(d);
  d.optional<double>("frequency")
      .unit("Hz")
      .range(0, kMaxRateHz)
      .live()
      .doc("at most half of the sample rate; a change keeps the phase");
  d.optional<std::int64_t>("period").range(2, 1 << 30).doc("samples of a cycle, in place of frequency");
  d.parameter("duty", 0.5)
      .unit("1")
      .above(0)
      .below(1)
      .live()
      .doc("part of a cycle that is high; with period rounded to whole samples, at least one and at most all but one");
  d.parameter("amplitude", 1.0).unit("").live().doc("half of the distance of the levels");
  d.parameter("offset", 0.0).unit("").live().doc("middle of the levels");
  d.parameter("phase", 0.0).unit("rad").range(-7, 7).doc("phase of the first sample");
  d.stream_out(out).doc("one channel");
}

void Square::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  start_phase_ = p.number("phase");
  if (p.has("frequency") == p.has("period")) fail("one of frequency and period must be given");
  period_ = p.has("period") ? whole(p, "period", 2, 1 << 30) : 0;
  change(p);
}

void Square::resolve(Facts& f) {
  StreamFacts& facts = f.out(out);
  facts = source_facts(rate_, unit_);
  if (period_ == 0 || static_cast<std::size_t>(period_) > kNotedPeriod) return;
  std::vector<double> cycle(static_cast<std::size_t>(period_));
  Phase phase = Phase::from_radians(start_phase_);
  for (double& value : cycle) {
    value = phase.fraction64() < wave_.end_of_high ? wave_.high : wave_.low;
    phase += step_;
  }
  note_period(facts, cycle);
}

void Square::activate(const Activation&) { reset(); }

void Square::process(Io& io) {
  const Wave wave = wave_;
  for (double& value : io.write(out)) {
    value = phase_.fraction64() < wave.end_of_high ? wave.high : wave.low;
    phase_ += step_;
  }
}

void Square::change(const Parameters& p) {
  const double duty = p.number("duty");
  if (!(duty > 0 && duty < 1)) fail("duty is " + std::to_string(duty) + ", allowed: between 0 and 1");
  const double amplitude = p.number("amplitude"), offset = p.number("offset");
  wave_.high = offset + amplitude;
  wave_.low = offset - amplitude;
  if (period_ > 0) {
    const auto size = static_cast<std::uint64_t>(period_);
    const double rounded = std::round(duty * static_cast<double>(size));
    const auto high = static_cast<std::uint64_t>(std::clamp(rounded, 1.0, static_cast<double>(size - 1)));
    step_ = Phase::step(1.0, Rate(period_, 1));
    // Half of a sample before the edge, so that the rounding of the phase does not matter.
    wave_.end_of_high = step_.times(high).fraction64() - step_.divided(2).fraction64();
    return;
  }
  const double frequency = p.number("frequency");
  if (!(frequency >= 0 && frequency <= 0.5 * rate_.hz()))
    fail("frequency is " + hertz(frequency) + ", allowed: at most half of the sample rate, " + hertz(0.5 * rate_.hz()));
  step_ = Phase::step(frequency, rate_);
  wave_.end_of_high = static_cast<std::uint64_t>(std::ldexp(duty, 64));
}

void Square::reset() { phase_ = Phase::from_radians(start_phase_); }

}  // namespace bodeflow::generators
