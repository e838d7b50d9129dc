#include "sine_block.hpp"

#include <cmath>

#include "source.hpp"

namespace bodeflow::generators {

void Sine::describe(Describe& d) {
  d.id("generators.sine").summary("Gives a sine of exact phase.").role("source").realtime_safe().cost_ns(5);
  d.doc(
      "y[n] = offset + amplitude sin(2 pi frequency n / sample_rate + phase). The phase is kept as a 128-bit fraction of a "
      "cycle: after n "
      "samples it is off by at most n 2^-129 cycles, so it never drifts, and a sample is good to 4e-16 of the amplitude. When "
      "the frequency "
      "changes while running, the phase goes on without a jump. A cosine has phase 90 deg.");
  describe_source(d);
  d.required<double>("frequency").unit("Hz").range(0, kMaxRateHz).live().doc("at most half of the sample rate");
  d.parameter("amplitude", 1.0).unit("").live().doc("peak value");
  d.parameter("phase", 0.0).unit("rad").range(-7, 7).doc("phase of the first sample");
  d.parameter("offset", 0.0).unit("").live().doc("mean value");
  d.stream_out(out).doc("one channel");
}

void Sine::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  start_phase_ = p.number("phase");
  change(p);
}

void Sine::resolve(Facts& f) {
  f.out(out) = source_facts(rate_, unit_);
  if (wave_.frequency == 0) return;
  f.out(out).notes["excitation.frequencies"] = {wave_.frequency};
  f.out(out).notes["excitation.amplitudes"] = {std::abs(wave_.amplitude)};
  f.out(out).notes["excitation.period"] = {1 / wave_.frequency};
}

void Sine::activate(const Activation&) { reset(); }

void Sine::process(Io& io) {
  // Phases first, in turn; then their sines, all alike.
  const auto y = io.write(out);
  for (double& cycles : y) {
    cycles = phase_.cycles();
    phase_ += step_;
  }
  const Wave wave = wave_;
  for (double& value : y) value = wave.offset + wave.amplitude * sine_of_cycles(value);
}

void Sine::change(const Parameters& p) {
  const Wave wave{p.number("frequency"), p.number("amplitude"), p.number("offset")};
  if (wave.frequency > 0.5 * rate_.hz()) {
    fail("frequency is " + hertz(wave.frequency) + ", allowed: at most half of the sample rate, " + hertz(0.5 * rate_.hz()));
  }
  wave_ = wave;
  step_ = Phase::step(wave.frequency, rate_);
}

void Sine::reset() { phase_ = Phase::from_radians(start_phase_); }

}  // namespace bodeflow::generators
