#include "narrow_band_pass_block.hpp"

#include <algorithm>
#include <numbers>

#include "iir_parameters.hpp"
#include "records/signals.hpp"

namespace bodeflow::filters {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

void NarrowBandPassBank::describe(Describe& d) {
  d.id("filters.narrow_band_pass").summary("Narrow band-pass filters around given frequencies, one channel each.").cost_ns(20);
  d.doc(
      "H(z) = prod_i (1 - r)(z^2 - 1) / (z^2 - 2 r cos(phi_i) z + r^2), phi_i = w h + ((m + 1) / 2 - i) spacing, i = 1 .. m: the "
      "poles stand at one distance from the unit circle, so none is near instability and the impulse response decays as r^k. "
      "Each "
      "section is a rotation, which is insensitive to rounding. Every channel of the input becomes one channel a frequency: all "
      "of "
      "the first channel, then all of the second ... The gain at a centre is only near 1 (0.5 to 1.1), below w h of about 1 - r "
      "the "
      "peak lies above the centre (narrow_low keeps it there); filter both signals of a response by the same block and it drops "
      "out. r = 0.9, m = 2: about 50 samples of memory, a delay of 19.");
  d.reference("A. Kallen, Frequency Domain Adaptive Control, Lund 1992, section 6.4");
  d.required<std::vector<double>>("frequencies").unit("Hz").doc("centres");
  d.parameter("radius", 0.9).unit("1").above(0).below(1).doc("r: of the poles; 0.8 and more is narrow");
  d.parameter("sections", std::int64_t{2}).range(1, numerics::NarrowBandPass::kMostSections).doc("m: each of order 2");
  d.parameter("spacing", 2 * kDegree).unit("rad").range(0, std::numbers::pi).doc("angle between neighbouring poles (2 deg)");
  d.parameter("narrow_low", false)
      .doc("r = 1 - min(1 - radius, w h / 2): low frequencies get filters as narrow, relative to them");
  describe_ports(d);
}

void NarrowBandPassBank::configure(const Parameters& p) {
  frequencies_hz_ = p.numbers("frequencies");
  if (frequencies_hz_.empty()) fail("frequencies is empty; allowed: one or more");
  radius_ = p.number("radius");
  sections_ = static_cast<int>(p.integer("sections"));
  spacing_ = p.number("spacing");
  narrow_low_ = p.boolean("narrow_low");
}

numerics::NarrowBandPass NarrowBandPassBank::one(double frequency_hz, double rate_hz) const {
  require_below_nyquist("frequencies", frequency_hz, rate_hz);
  const double w_h = angle(frequency_hz, rate_hz);
  const double r = narrow_low_ ? 1 - std::min(1 - radius_, 0.5 * w_h) : radius_;
  return value_or_fail(
      numerics::NarrowBandPass::design(r, sections_, spacing_, w_h),
      "frequencies: " + records::short_number(frequency_hz) + " Hz at " + records::short_number(rate_hz) + " samples/s");
}

std::vector<BankFilter> NarrowBandPassBank::design(double rate_hz) const {
  std::vector<BankFilter> filters;
  for (const double f : frequencies_hz_) filters.push_back({records::short_number(f) + " Hz", one(f, rate_hz)});
  return filters;
}

std::string NarrowBandPassBank::kind() const {
  return "narrow band-pass filters of order " + std::to_string(2 * sections_) + ", r = " + records::short_number(radius_);
}

}  // namespace bodeflow::filters
