#include "known_response_block.hpp"

#include <algorithm>

#include "block_settings.hpp"

namespace bodeflow::adaptive_control {

void KnownResponse::describe(Describe& d) {
  d.id("adaptive_control.known_response")
      .summary("Gives the response of a known plant at the frequencies of fitting, in place of an estimator.")
      .realtime_safe()
      .cost_ns(5);
  d.doc(
      "The plant is held over each sample (zero-order hold), its delay need not be whole. Before adaptive_control.design it "
      "makes the "
      "nominal controller, which an adaptive one is compared with. `y` gives the sample rate, its values are not used.");
  describe_frequencies(d);
  describe_plant(d, true);
  d.stream_in(y).doc("a signal of the loop's sample rate");
  d.stream_out(response).doc("one complex channel a frequency");
}

void KnownResponse::configure(const Parameters& p) {
  omega_ = p.numbers("frequencies");
  if (omega_.empty()) fail("no frequencies");
  numerator_ = p.numbers("plant.numerator");
  denominator_ = p.numbers("plant.denominator");
  delay_s_ = p.number("plant.delay");
}

std::vector<std::complex<double>> KnownResponse::at(double sample_time) const {
  return value_or_fail(sampled_response({vector_of(numerator_), vector_of(denominator_), 0.0}, delay_s_, sample_time, omega_));
}

void KnownResponse::resolve(Facts& f) {
  if (!f.in(y).known) return;
  at(1.0 / f.in(y).rate.hz());
  StreamFacts& g = f.out(response);
  g.known = true;
  g.channels = static_cast<int>(omega_.size());
  g.rate = f.in(y).rate;
  g.length = f.in(y).length;
  g.clock = f.in(y).clock;
  g.notes["fit.frequencies"] = omega_;
}

void KnownResponse::activate(const Activation& a) { points_ = at(1.0 / a.rate.hz()); }

void KnownResponse::process(Io& io) {
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const auto g = io.write(response, static_cast<int>(j));
    std::fill(g.begin(), g.end(), points_[j]);
  }
}

}  // namespace bodeflow::adaptive_control
