#include "delay_block.hpp"

#include <algorithm>

namespace bodeflow::filters {
namespace {

template <class T>
void copy(Io& io) {
  for (int c = 0; c < io.channels(Delay::in); ++c) {
    const auto x = io.read<T>(Delay::in, c);
    const auto y = io.write<T>(Delay::out, c);
    if (y.data() != x.data()) std::copy(x.begin(), x.end(), y.begin());
  }
}

}  // namespace

void Delay::describe(Describe& d) {
  d.id("filters.delay").summary("Delays a stream by whole samples.").realtime_safe().in_place().cost_ns(0.1);
  d.doc(
      "y[n] = x[n - samples]; before the first input the initial values come out. A feedback loop needs a delay of at least one "
      "sample "
      "somewhere: this block is one way to give it. A stream with an end keeps its length, its last samples stay in the delay.");
  d.required<std::int64_t>("samples").range(1, 1 << 24).doc("delay in samples of this stream");
  d.parameter("initial", std::vector<double>{0.0})
      .unit("")
      .doc("what comes out at first, in every channel: one value, or one a sample in order of time");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
}

void Delay::configure(const Parameters& p) {
  samples_ = p.integer("samples");
  initial_ = p.numbers("initial");
  if (initial_.size() != 1 && initial_.size() != static_cast<std::size_t>(samples_)) {
    fail("initial has " + std::to_string(initial_.size()) + " values, allowed: 1, or as many as the delay has samples (" +
         std::to_string(samples_) + ")");
  }
}

void Delay::resolve(Facts& f) { f.delay(in, samples_, initial_values(f.in(in))); }

void Delay::process(Io& io) {
  if (io.element(in) == BF_C64) {
    copy<std::complex<double>>(io);
  } else {
    copy<double>(io);
  }
}

std::vector<double> Delay::initial_values(const StreamFacts& input) const {
  std::vector<double> values;
  if (!input.known || std::all_of(initial_.begin(), initial_.end(), [](double x) { return x == 0; })) return values;
  for (int c = 0; c < input.channels; ++c) {
    for (std::int64_t n = 0; n < samples_; ++n) {
      values.push_back(initial_[initial_.size() == 1 ? 0 : static_cast<std::size_t>(n)]);
      if (input.element == BF_C64) values.push_back(0.0);
    }
  }
  return values;
}

}  // namespace bodeflow::filters
