#include "prbs_block.hpp"

#include <algorithm>

#include "period_notes.hpp"
#include "source.hpp"

namespace bodeflow::generators {

void Prbs::describe(Describe& d) {
  d.id("generators.prbs")
      .summary("Gives a pseudo-random binary sequence of maximal length.")
      .role("source")
      .realtime_safe()
      .cost_ns(2);
  d.doc(
      "A linear feedback shift register of `bits` stages gives 2^bits - 1 bits before it repeats, each held for `hold` samples: "
      "a 1 is offset + "
      "amplitude, a 0 offset - amplitude. The autocorrelation has two values only, so all lines k have the same power but for "
      "the hold: a factor "
      "|sin(pi k / M) / (hold sin(pi k / (hold M)))|^2 with M = 2^bits - 1; lines at multiples of M are empty. The mean of a "
      "period is amplitude "
      "/ M above offset. With inverse_repeat every other bit is inverted: the period doubles, the mean is offset, and even lines "
      "are empty, as "
      "odd excitation wants them. Take so many bits that a period is longer than the transient of the plant.");
  d.reference(
      "P. Alfke, Efficient shift registers, LFSR counters, and long pseudo-random sequence generators, Xilinx XAPP 052, 1996 "
      "(table of feedback "
      "stages)");
  d.reference("K. R. Godfrey, Introduction to binary signals used in system identification, IEE Control 91, 1991");
  describe_source(d);
  d.required<std::int64_t>("bits").range(kLeastBits, kMostBits).doc("stages of the register");
  d.parameter("hold", std::int64_t{1}).range(1, 1e6).doc("samples of a bit: the clock divider");
  d.parameter("inverse_repeat", false).doc("invert every other bit");
  d.parameter("amplitude", 1.0).unit("").live().doc("half of the distance of the levels");
  d.parameter("offset", 0.0).unit("").live().doc("middle of the levels");
  d.parameter("first_bit", std::int64_t{0}).range(0, 1e6).doc("bits of the sequence that are left out before the first sample");
  d.optional<std::int64_t>("periods").range(1, 1e6).doc("the stream ends after as many periods");
  d.stream_out(out).doc("one channel");
}

void Prbs::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  bits_ = static_cast<int>(whole(p, "bits", kLeastBits, kMostBits));
  hold_ = whole(p, "hold", 1, 1'000'000);
  inverse_repeat_ = p.boolean("inverse_repeat");
  first_bit_ = whole(p, "first_bit", 0, 1'000'000);
  const std::int64_t periods = p.has("periods") ? whole(p, "periods", 1, 1'000'000) : 0;
  if (periods > INT64_MAX / period()) fail(std::to_string(periods) + " periods have more samples than can be counted");
  length_ = periods > 0 ? periods * period() : -1;
  change(p);
}

void Prbs::resolve(Facts& f) {
  StreamFacts& facts = f.out(out);
  facts = source_facts(rate_, unit_, 1, length_);
  facts.notes["excitation.period"] = {static_cast<double>(period()) / rate_.hz()};
  if (period() > static_cast<std::int64_t>(kNotedPeriod)) return;
  Bits state = start();
  std::vector<double> samples(static_cast<std::size_t>(period()));
  for (double& value : samples) value = state.next(hold_, inverse_repeat_) ? high_ : low_;
  note_period(facts, samples);
}

void Prbs::activate(const Activation&) { reset(); }

void Prbs::process(Io& io) {
  const auto y = io.write(out);
  const std::size_t wanted = before_end(io, length_);
  for (std::size_t n = 0; n < wanted; ++n) y[n] = state_.next(hold_, inverse_repeat_) ? high_ : low_;
  std::fill(y.begin() + static_cast<std::ptrdiff_t>(wanted), y.end(), 0.0);
}

void Prbs::change(const Parameters& p) {
  low_ = p.number("offset") - p.number("amplitude");
  high_ = p.number("offset") + p.number("amplitude");
}

void Prbs::reset() { state_ = start(); }

Prbs::Bits Prbs::start() const {
  Bits state{ShiftRegister(bits_)};
  for (std::int64_t bit = 0; bit < first_bit_; ++bit) state.next(1, inverse_repeat_);
  return state;
}

bool Prbs::Bits::next(std::int64_t hold, bool inverse_repeat) {
  if (held == 0) {
    value = source.next() != inverted;
    if (inverse_repeat) inverted = !inverted;
    held = hold;
  }
  --held;
  return value;
}

std::int64_t Prbs::period() const { return ((std::int64_t{1} << bits_) - 1) * hold_ * (inverse_repeat_ ? 2 : 1); }

}  // namespace bodeflow::generators
