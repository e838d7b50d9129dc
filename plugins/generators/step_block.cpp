#include "step_block.hpp"

#include "source.hpp"

namespace bodeflow::generators {

void Step::describe(Describe& d) {
  d.id("generators.step").summary("Gives a step at a stated time.").role("source").realtime_safe().cost_ns(0.5);
  d.doc("y[n] = offset before `time`, offset + amplitude from the first sample at or after it.");
  describe_source(d);
  d.parameter("time", 0.0).unit("s").range(0, 1e12).doc("of the step, from the start of the stream");
  d.parameter("amplitude", 1.0).unit("").live().doc("height of the step");
  d.parameter("offset", 0.0).unit("").live().doc("value before the step");
  d.stream_out(out).doc("one channel");
}

void Step::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  first_ = first_sample(p.number("time"), rate_);
  change(p);
}

void Step::resolve(Facts& f) { f.out(out) = source_facts(rate_, unit_); }

void Step::process(Io& io) {
  std::uint64_t n = io.position();
  for (double& value : io.write(out)) value = n++ < first_ ? before_ : after_;
}

void Step::change(const Parameters& p) {
  before_ = p.number("offset");
  after_ = before_ + p.number("amplitude");
}

}  // namespace bodeflow::generators
