#include "interpolate_block.hpp"

#include <Eigen/Core>

#include "decimator.hpp"
#include "filter_record.hpp"
#include "iir_parameters.hpp"
#include "notes.hpp"

namespace bodeflow::filters {

void Interpolate::describe(Describe& d) {
  d.id("filters.interpolate")
      .summary("Raises the sample rate by a whole factor, behind a filter that removes the images.")
      .cost_ns(250);
  d.realtime_safe();
  d.doc(
      "y[factor m + p] = sum_j h[factor j + p] x[m - j]: zeros between the samples, then the low pass of filters.decimate times "
      "factor. It passes up to pass_band of the old Nyquist frequency and stops the images from there on. The delay is a whole "
      "number of input samples, K = 26 for 80 dB and 0.8. For what a converter does use filters.hold.");
  d.reference("J. F. Kaiser, Nonrecursive digital filter design using the I0-sinh window function, 1974");
  d.required<std::int64_t>("factor").range(1, 1 << 16).doc("output samples for each input sample");
  d.parameter("pass_band", 0.8)
      .unit("1")
      .range(0.1, 0.98)
      .doc("end of the pass band, as a fraction of the old Nyquist frequency");
  d.parameter("attenuation", 80.0).unit("dB").range(21, 160).doc("of all images");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
  d.message_out(filter).record_type("filter").doc("at the end: impulse and frequency response at the higher rate");
}

void Interpolate::configure(const Parameters& p) {
  factor_ = p.integer("factor");
  taps_ = {1.0};
  if (factor_ == 1) return;
  taps_ =
      value_or_fail(anti_alias_taps(static_cast<std::size_t>(factor_), p.number("pass_band"), p.number("attenuation")), "filter");
  for (double& h : taps_) h *= static_cast<double>(factor_);
}

void Interpolate::resolve(Facts& f) {
  f.samples(out, factor_);
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  channels_ = x.channels;
  StreamFacts& y = f.out(out);
  y.rate = x.rate.scaled(factor_, 1);
  if (y.length >= 0) y.length *= factor_;
  rate_hz_ = y.rate.hz();
  y.notes = filtered(x.notes, static_cast<double>(taps_.size()) / rate_hz_);
}

void Interpolate::activate(const Activation& a) {
  interpolators_.assign(static_cast<std::size_t>(channels_),
                        Interpolator(taps_, static_cast<std::size_t>(factor_), static_cast<std::size_t>(a.max_count)));
}

void Interpolate::process(Io& io) {
  for (std::size_t c = 0; c < interpolators_.size(); ++c) {
    interpolators_[c].run(io.read(in, static_cast<int>(c)), io.write(out, static_cast<int>(c)));
  }
}

void Interpolate::finish(Io& io) {
  const Eigen::Map<const Eigen::VectorXd> h(taps_.data(), static_cast<Eigen::Index>(taps_.size()));
  io.emit(filter, fir_record("interpolation by " + std::to_string(factor_), rate_hz_, h / static_cast<double>(factor_)));
}

void Interpolate::reset() {
  for (Interpolator& interpolator : interpolators_) interpolator.reset();
}

}  // namespace bodeflow::filters
