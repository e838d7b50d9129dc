#include "gain_block.hpp"

#include <bodeflow/numerics/kernels.hpp>

#include "notes.hpp"

namespace bodeflow::filters {

void Gain::describe(Describe& d) {
  d.id("filters.gain").summary("Multiplies a stream by a constant.").realtime_safe().in_place().cost_ns(0.2);
  d.doc("y[n] = gain x[n] in every channel, real or complex.");
  d.parameter("gain", 1.0).unit("").live().doc("factor; may carry a unit of its own, such as 5 V/A");
  d.optional<std::string>("unit").doc("unit of the output; that of the input where it is left out");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
}

void Gain::configure(const Parameters& p) {
  change(p);
  has_unit_ = p.has("unit");
  if (has_unit_) unit_ = p.text("unit");
}

void Gain::resolve(Facts& f) {
  f.out(out).notes = scaled(std::move(f.out(out).notes), gain_);
  if (!has_unit_ || !f.out(out).known) return;
  f.out(out).unit = unit_;
  f.out(out).channel_units.clear();
}

void Gain::process(Io& io) {
  if (io.element(in) == BF_C64) {
    multiply<std::complex<double>>(io);
  } else {
    multiply<double>(io);
  }
}

void Gain::change(const Parameters& p) { gain_ = p.number("gain"); }

template <class T>
void Gain::multiply(Io& io) const {
  // A complex sample times a real factor is two real products.
  constexpr std::size_t kParts = sizeof(T) / sizeof(double);
  for (int c = 0; c < io.channels(in); ++c) {
    const auto x = io.read<T>(in, c);
    const auto y = io.write<T>(out, c);
    numerics::multiply(reinterpret_cast<const double*>(x.data()), gain_, reinterpret_cast<double*>(y.data()), kParts * x.size(),
                       vector_level_);
  }
}

}  // namespace bodeflow::filters
