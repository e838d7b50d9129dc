#include "hold_block.hpp"

#include <algorithm>

namespace bodeflow::filters {

void Hold::describe(Describe& d) {
  d.id("filters.hold")
      .summary("Raises the sample rate by a whole factor, holding each sample (zero-order hold).")
      .realtime_safe()
      .cost_ns(5);
  d.doc(
      "y[factor m + j] = x[m] for j = 0 .. factor - 1, as a digital-to-analogue converter does it. Against the spectrum of x the "
      "output has the "
      "response of the hold, |sin(pi f T) / (pi f T)| with a delay of T / 2, T the sample time of x, and images beyond the "
      "Nyquist frequency of x.");
  d.required<std::int64_t>("factor").range(1, 1 << 24).doc("output samples for each input sample");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
}

void Hold::configure(const Parameters& p) { factor_ = p.integer("factor"); }

void Hold::resolve(Facts& f) {
  f.samples(out, factor_);
  StreamFacts& y = f.out(out);
  y.rate = y.rate.scaled(factor_, 1);
  if (y.length >= 0) y.length *= factor_;
  y.notes.erase("noise.std");  // held noise is not white
}

void Hold::process(Io& io) {
  if (io.element(in) == BF_C64) {
    repeat<std::complex<double>>(io);
  } else {
    repeat<double>(io);
  }
}

template <class T>
void Hold::repeat(Io& io) const {
  for (int c = 0; c < io.channels(in); ++c) {
    auto y = io.write<T>(out, c).begin();
    for (const T& x : io.read<T>(in, c)) y = std::fill_n(y, factor_, x);
  }
}

}  // namespace bodeflow::filters
