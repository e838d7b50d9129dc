#include "decimate_block.hpp"

#include <Eigen/Core>
#include <cmath>
#include <numeric>

#include "filter_record.hpp"

namespace bodeflow::filters {

void Decimate::describe(Describe& d) {
  d.id("filters.decimate")
      .summary("Lowers the sample rate by a whole factor, behind an anti-alias filter.")
      .realtime_safe()
      .cost_ns(250);
  d.doc(
      "y[m] = sum_j h[j] x[m factor - j], h a Kaiser-windowed sinc of linear phase with gain 1 at zero frequency: it passes up "
      "to pass_band of the new Nyquist frequency (ripple at most twice the attenuation's figure, 2e-4 for 80 dB) and stops from "
      "the new Nyquist frequency on. Its delay is the same at all frequencies and a whole number of output samples, K = 26 for "
      "80 dB and 0.8, so a spectrum is only turned by exp(-j 2 pi f K / rate); the first 2 K outputs contain the start from "
      "zero. With anti_alias: false y[m] = x[m factor], without delay, and all that lies above the new Nyquist frequency folds "
      "down.");
  d.reference("J. F. Kaiser, Nonrecursive digital filter design using the I0-sinh window function, 1974");
  d.required<std::int64_t>("factor").range(1, 1 << 16).doc("input samples for each output sample");
  d.parameter("anti_alias", true).doc("false: samples are left out without a filter");
  d.parameter("pass_band", 0.8)
      .unit("1")
      .range(0.1, 0.98)
      .doc("end of the pass band, as a fraction of the new Nyquist frequency");
  d.parameter("attenuation", 80.0).unit("dB").range(21, 160).doc("of all that would fold down");
  d.stream_in(in);
  d.stream_out(out).same_as(in);
  d.message_out(filter).record_type("filter").doc(
      "at the end: impulse and frequency response of the anti-alias filter at the higher rate");
}

void Decimate::configure(const Parameters& p) {
  factor_ = p.integer("factor");
  taps_ = {1.0};
  if (!p.boolean("anti_alias") || factor_ == 1) return;
  auto taps = anti_alias_taps(static_cast<std::size_t>(factor_), p.number("pass_band"), p.number("attenuation"));
  if (!taps) fail(taps.error().text);
  taps_ = std::move(*taps);
}

void Decimate::resolve(Facts& f) {
  f.samples(in, factor_);
  channels_ = f.in(in).channels;
  rate_hz_ = f.in(in).rate.hz();
  StreamFacts& y = f.out(out);
  y.rate = y.rate.scaled(1, factor_);
  if (y.length >= 0) y.length /= factor_;
  const auto noise = y.notes.find("noise.std");
  if (noise == y.notes.end()) return;
  const double power_gain = std::inner_product(taps_.begin(), taps_.end(), taps_.begin(), 0.0);
  for (double& std : noise->second) std *= std::sqrt(power_gain);
}

void Decimate::activate(const Activation& a) {
  decimators_.assign(static_cast<std::size_t>(channels_),
                     Decimator(taps_, static_cast<std::size_t>(factor_), static_cast<std::size_t>(a.max_count)));
}

void Decimate::process(Io& io) {
  for (std::size_t c = 0; c < decimators_.size(); ++c) {
    decimators_[c].run(io.read(in, static_cast<int>(c)), io.write(out, static_cast<int>(c)));
  }
}

void Decimate::finish(Io& io) {
  if (taps_.size() == 1) return;
  const Eigen::Map<const Eigen::VectorXd> h(taps_.data(), static_cast<Eigen::Index>(taps_.size()));
  io.emit(filter, fir_record("decimation by " + std::to_string(factor_), rate_hz_, h));
}

void Decimate::reset() {
  for (Decimator& decimator : decimators_) decimator.reset();
}

}  // namespace bodeflow::filters
