#include "chirp_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "period_notes.hpp"
#include "source.hpp"

namespace bodeflow::generators {

void Chirp::describe(Describe& d) {
  d.id("generators.chirp")
      .summary("Gives a sine that sweeps over a band, once or periodically.")
      .role("source")
      .realtime_safe()
      .cost_ns(15);
  d.doc(
      "y[n] = offset + amplitude sin(phi(t)) with t = n / sample_rate within a period T of `period` samples, phi = 2 pi (f1 t + "
      "(f2 - f1) t^2 "
      "/ (2 T)) (linear) or phi = 2 pi f1 T / ln r (r^(t/T) - 1), r = f2 / f1 (logarithmic: the same time for each octave). The "
      "linear phase "
      "is exact to 2^-60 cycles, the logarithmic one to 1e-15 of the cycles since its start. The power is even over the band "
      "(linear) or "
      "falls with 1/f (logarithmic), with ripple at the ends of the band and a little power beyond. Periodic and in steady state "
      "it is analysed "
      "as a multisine on the lines of its period.");
  d.reference("R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapter 5");
  d.reference(
      "A. Farina, Simultaneous measurement of impulse response and distortion with a swept-sine technique, AES 108, 2000");
  describe_source(d);
  d.required<double>("from")
      .unit("Hz")
      .range(0, kMaxRateHz)
      .doc("f1, the frequency at the start of a sweep; at most half of the sample rate");
  d.required<double>("to").unit("Hz").range(0, kMaxRateHz).doc("f2, the frequency at its end; it may be below `from`");
  d.required<std::int64_t>("period").range(2, 4294967296.0).doc("samples of a sweep");
  d.parameter("sweep", "linear").choices({"linear", "logarithmic"}).doc("of the frequency over time");
  d.parameter("repeat", true).doc("false: after one sweep the output stays at offset");
  d.optional<std::int64_t>("periods").range(1, 1e9).doc("the stream ends after as many periods");
  d.parameter("amplitude", 1.0).unit("").live().doc("peak value");
  d.parameter("offset", 0.0).unit("").live().doc("mean value");
  d.parameter("phase", 0.0).unit("rad").range(-7, 7).doc("phase at the start of a sweep");
  d.stream_out(out).doc("one channel");
}

void Chirp::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  period_ = static_cast<std::uint64_t>(whole(p, "period", 2, std::int64_t{1} << 32));
  repeat_ = p.boolean("repeat");
  length_ = p.has("periods") ? p.integer("period") * whole(p, "periods", 1, 1'000'000'000) : -1;
  start_cycles_ = p.number("phase") / (2 * std::numbers::pi);
  const bool logarithmic = p.text("sweep") == "logarithmic";
  for (const char* name : {"from", "to"}) {
    const double frequency = p.number(name);
    if (!(frequency >= 0 && frequency <= 0.5 * rate_.hz())) {
      fail(std::string(name) + " is " + hertz(frequency) + ", allowed: at most half of the sample rate, " +
           hertz(0.5 * rate_.hz()));
    }
    if (logarithmic && frequency == 0) fail(std::string(name) + " is 0 Hz, allowed: above zero for a logarithmic sweep");
  }
  sweep_ = Sweep(logarithmic ? Sweep::Law::logarithmic : Sweep::Law::linear, p.number("from"), p.number("to"), period_, rate_);
  change(p);
}

void Chirp::resolve(Facts& f) {
  StreamFacts& facts = f.out(out);
  facts = source_facts(rate_, unit_, 1, length_);
  if (!repeat_ || period_ > kNotedPeriod) return;
  std::vector<double> samples(static_cast<std::size_t>(period_));
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = value(n);
  note_period(facts, samples);
}

void Chirp::process(Io& io) {
  const auto y = io.write(out);
  const std::size_t wanted = before_end(io, length_);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::uint64_t n = io.position() + i;
    y[i] = repeat_ || n < period_ ? value(n % period_) : wave_.offset;
  }
  std::fill(y.begin() + static_cast<std::ptrdiff_t>(wanted), y.end(), 0.0);
}

void Chirp::change(const Parameters& p) { wave_ = {p.number("amplitude"), p.number("offset")}; }

double Chirp::value(std::uint64_t n) const {
  const double cycles = sweep_.cycles(n) + start_cycles_;
  return wave_.offset + wave_.amplitude * sine_of_cycles(cycles - std::nearbyint(cycles));
}

}  // namespace bodeflow::generators
