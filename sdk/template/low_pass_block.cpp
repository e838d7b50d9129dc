#include "low_pass_block.hpp"

void LowPassBlock::describe(bodeflow::Describe& d) {
  d.id("@NAME@.low_pass").summary("Filters each channel with a first-order low pass.").realtime_safe().in_place().cost_ns(3);
  d.stream_in(in).doc("any number of channels");
  d.stream_out(out).same_as(in).doc("filtered, channel by channel");
  d.parameter("corner", 10.0).unit("Hz").above(0.0).live().doc("frequency at which the gain is 1/sqrt(2)");
}

void LowPassBlock::configure(const bodeflow::Parameters& p) { corner_hz_ = p.number("corner"); }

// `same_as` has given the output the input's facts already.
void LowPassBlock::resolve(bodeflow::Facts& f) { channels_ = f.in(in).channels; }

void LowPassBlock::activate(const bodeflow::Activation& a) {
  filters_.assign(static_cast<std::size_t>(channels_), LowPass(corner_hz_, a.rate.hz()));
}

void LowPassBlock::change(const bodeflow::Parameters& p) {
  for (LowPass& filter : filters_) filter.set_corner(p.number("corner"));
}

void LowPassBlock::process(bodeflow::Io& io) {
  for (int c = 0; c < io.channels(in); ++c) {
    const auto x = io.read(in, c);
    const auto y = io.write(out, c);
    LowPass& filter = filters_[static_cast<std::size_t>(c)];
    for (std::size_t n = 0; n < x.size(); ++n) y[n] = filter.step(x[n]);
  }
}

void LowPassBlock::reset() {
  for (LowPass& filter : filters_) filter.reset();
}
