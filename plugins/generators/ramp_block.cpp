#include "ramp_block.hpp"

#include <algorithm>
#include <limits>

#include "source.hpp"

namespace bodeflow::generators {

void Ramp::describe(Describe& d) {
  d.id("generators.ramp").summary("Gives a ramp of stated slope and duration.").role("source").realtime_safe().cost_ns(2);
  d.doc("y[n] = offset + slope min(max(n / sample_rate - time, 0), duration).");
  describe_source(d);
  d.parameter("time", 0.0).unit("s").range(0, 1e12).doc("at which the ramp begins");
  d.required<double>("slope").unit("").doc("rise in one second, in the unit of the stream");
  d.optional<double>("duration").unit("s").range(0, 1e12).doc("of the ramp; without it, it never ends");
  d.parameter("offset", 0.0).unit("").doc("value before the ramp");
  d.stream_out(out).doc("one channel");
}

void Ramp::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  time_s_ = p.number("time");
  slope_ = p.number("slope");
  duration_s_ = p.has("duration") ? p.number("duration") : std::numeric_limits<double>::infinity();
  offset_ = p.number("offset");
}

void Ramp::resolve(Facts& f) { f.out(out) = source_facts(rate_, unit_); }

void Ramp::process(Io& io) {
  std::uint64_t n = io.position();
  for (double& value : io.write(out)) {
    const double since_s = static_cast<double>(n++) / rate_.hz() - time_s_;
    value = offset_ + slope_ * std::min(std::max(since_s, 0.0), duration_s_);
  }
}

}  // namespace bodeflow::generators
