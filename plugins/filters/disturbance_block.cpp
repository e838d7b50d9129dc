#include "disturbance_block.hpp"

#include "iir_parameters.hpp"

namespace bodeflow::filters {

void Disturbance::describe(Describe& d) {
  d.id("filters.disturbance").summary("Takes steps, ramps and sinusoids out of the data of an estimator.").cost_ns(10);
  d.doc(
      "H(q) = A_d(q) / A_f(q): A_d(q) holds (q - 1)^steps and q^2 - 2 cos(w h) q + 1 for each sinusoid, the poles of what "
      "generates "
      "such disturbances, so each leaves only a transient behind, as long as A_f makes it. A_f makes the rest a band-pass filter "
      "of "
      "gain 1: Butterworth poles at `low` for the steps, notches of `width`, a low pass at `high`. Rule of thumb: low at least a "
      "decade below the bandwidth of the closed loop, high 2 to 10 times above it. Filter the input and the output of a plant by "
      "the same block.");
  d.reference("A. Kallen, Frequency Domain Adaptive Control, Lund 1992, section 6.3");
  d.parameter("steps", std::int64_t{1})
      .range(0, 3)
      .doc("zeros at zero frequency: 1 takes out steps, 2 ramps too, 3 parabolas too");
  d.optional<double>("low").unit("Hz").above(0).doc("-3 dB below the pass band; needed with steps");
  d.parameter("sinusoids", std::vector<double>{}).unit("Hz").doc("frequencies of sinusoids to take out");
  d.optional<double>("width").unit("Hz").above(0).doc("of their notches; needed with sinusoids");
  d.parameter("order", std::int64_t{2}).range(0, numerics::kMostFilterOrder).doc("of the low pass; 0: none");
  d.optional<double>("high").unit("Hz").above(0).doc("-3 dB above the pass band; needed with an order above 0");
  d.parameter("family", "butterworth").choices({"butterworth", "bessel"}).doc("of the low pass");
  describe_ports(d);
}

void Disturbance::configure(const Parameters& p) {
  steps_ = static_cast<int>(p.integer("steps"));
  sinusoids_hz_ = p.numbers("sinusoids");
  order_ = static_cast<int>(p.integer("order"));
  bessel_ = p.text("family") == "bessel";
  if (steps_ > 0 && !p.has("low")) fail("steps needs low, the lower edge of the pass band");
  if (!sinusoids_hz_.empty() && !p.has("width")) fail("sinusoids needs width, that of their notches");
  if (order_ > 0 && !p.has("high")) fail("order needs high, the upper edge of the pass band");
  low_hz_ = p.has("low") ? p.number("low") : 0.0;
  width_hz_ = p.has("width") ? p.number("width") : 0.0;
  high_hz_ = p.has("high") ? p.number("high") : 0.0;
}

DisturbanceDesign Disturbance::at(double rate_hz) const {
  DisturbanceDesign d;
  d.steps = steps_;
  d.order = order_;
  d.bessel = bessel_;
  if (steps_ > 0) require_below_nyquist("low", low_hz_, rate_hz);
  if (order_ > 0) require_below_nyquist("high", high_hz_, rate_hz);
  if (!sinusoids_hz_.empty()) require_below_nyquist("width", width_hz_, rate_hz);
  d.low = angle(low_hz_, rate_hz);
  d.high = angle(high_hz_, rate_hz);
  d.width = angle(width_hz_, rate_hz);
  for (const double f : sinusoids_hz_) {
    require_below_nyquist("sinusoids", f, rate_hz);
    d.sinusoids.push_back(angle(f, rate_hz));
  }
  return d;
}

std::vector<BankFilter> Disturbance::design(double rate_hz) const {
  return {{"filter", value_or_fail(disturbance_filter(at(rate_hz)), "filter")}};
}

std::string Disturbance::kind() const { return "disturbance filter"; }

}  // namespace bodeflow::filters
