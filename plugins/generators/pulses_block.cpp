#include "pulses_block.hpp"

#include <algorithm>
#include <cmath>

#include "period_notes.hpp"
#include "source.hpp"

namespace bodeflow::generators {
namespace {

std::string seconds(double time_s) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g s", time_s);
  return text;
}

}  // namespace

void Pulses::describe(Describe& d) {
  d.id("generators.pulses").summary("Gives rectangular pulses at stated times.").role("source").realtime_safe().cost_ns(5);
  d.doc(
      "y[n] = offset + amplitude of the pulse that sample n lies in: from the first sample at or after its time to the last "
      "before time + width. "
      "Pulses follow each other without overlap; the sum of two such blocks gives pulses that overlap. With `period` the "
      "sequence repeats.");
  describe_source(d);
  d.required<std::vector<double>>("times").unit("s").range(0, 1e12).doc("at which the pulses begin, rising");
  d.required<std::vector<double>>("widths").unit("s").range(0, 1e12).doc("of the pulses: one for all, or one a pulse");
  d.parameter("amplitudes", std::vector<double>{1.0}).unit("").doc("of the pulses over offset: one for all, or one a pulse");
  d.optional<double>("period").unit("s").range(0, 1e12).doc("after which the sequence repeats, a whole number of samples");
  d.parameter("offset", 0.0).unit("").doc("value between the pulses");
  d.stream_out(out).doc("one channel");
}

void Pulses::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  offset_ = p.number("offset");
  take_pulses(p);
  take_period(p);
}

void Pulses::take_pulses(const Parameters& p) {
  const std::vector<double>& times = p.numbers("times");
  if (times.empty()) fail("times is empty");
  const auto each = [&](const char* name, std::size_t i) {
    const std::vector<double>& values = p.numbers(name);
    if (values.size() != 1 && values.size() != times.size()) {
      fail(std::string(name) + " has " + std::to_string(values.size()) + " values, allowed: 1, or one for each of the " +
           std::to_string(times.size()) + " times");
    }
    return values[values.size() == 1 ? 0 : i];
  };
  pulses_.clear();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double width = each("widths", i);
    const Pulse pulse{first_sample(times[i], rate_), first_sample(times[i] + width, rate_), each("amplitudes", i)};
    const std::string name = "pulse " + std::to_string(i + 1) + " at " + seconds(times[i]);
    if (pulse.begin >= pulse.end)
      fail(name + " with a width of " + seconds(width) + " holds no sample; samples are " + seconds(1 / rate_.hz()) + " apart");
    if (i > 0 && pulse.begin < pulses_.back().end) fail(name + " begins before the pulse ahead of it has ended");
    pulses_.push_back(pulse);
  }
}

void Pulses::take_period(const Parameters& p) {
  period_ = 0;
  if (!p.has("period")) return;
  const double period_s = p.number("period");
  period_ = first_sample(period_s, rate_);
  if (period_ < pulses_.back().end) fail("period is " + seconds(period_s) + ", but the last pulse ends after it");
  const double samples = period_s * rate_.hz();
  if (std::abs(samples - static_cast<double>(period_)) > 1e-6 + 1e-15 * samples)
    fail("period is " + seconds(period_s) +
         ", no whole number of samples; near it: " + seconds(static_cast<double>(period_) / rate_.hz()));
}

void Pulses::resolve(Facts& f) {
  StreamFacts& facts = f.out(out);
  facts = source_facts(rate_, unit_);
  if (period_ == 0 || period_ > kNotedPeriod) return;
  std::vector<double> samples(static_cast<std::size_t>(period_));
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = value(n);
  note_period(facts, samples);
}

void Pulses::process(Io& io) {
  std::uint64_t n = io.position();
  for (double& y : io.write(out)) {
    y = value(period_ > 0 ? n % period_ : n);
    ++n;
  }
}

double Pulses::value(std::uint64_t n) const {
  const auto next =
      std::upper_bound(pulses_.begin(), pulses_.end(), n, [](std::uint64_t at, const Pulse& pulse) { return at < pulse.end; });
  return next != pulses_.end() && n >= next->begin ? offset_ + next->amplitude : offset_;
}

}  // namespace bodeflow::generators
