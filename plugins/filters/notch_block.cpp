#include "notch_block.hpp"

#include "iir_parameters.hpp"
#include "notch_section.hpp"
#include "records/signals.hpp"

namespace bodeflow::filters {

void Notch::describe(Describe& d) {
  d.id("filters.notch").summary("Takes single frequencies out of a stream.").cost_ns(8);
  d.doc(
      "One second-order section a frequency: (s^2 + w^2) / (s^2 + 2 pi width s + w^2) by the bilinear transformation, "
      "pre-warped. "
      "Its zeros lie exactly at the frequency, the gain is 1 at zero and at the Nyquist frequency and -3 dB at the ends of the "
      "width. A sinusoid that begins is gone after about 1 / width.");
  d.required<std::vector<double>>("frequencies").unit("Hz").doc("what to take out: mains and harmonics, a resonance");
  d.required<std::vector<double>>("width").unit("Hz").doc("between the -3 dB points; one for all, or one a frequency");
  describe_ports(d);
}

void Notch::configure(const Parameters& p) {
  frequencies_hz_ = p.numbers("frequencies");
  widths_hz_ = p.numbers("width");
  if (frequencies_hz_.empty()) fail("frequencies is empty; allowed: one or more");
  if (widths_hz_.size() == 1) widths_hz_.resize(frequencies_hz_.size(), widths_hz_[0]);
  if (widths_hz_.size() != frequencies_hz_.size()) {
    fail("width has " + std::to_string(widths_hz_.size()) + " values for " + std::to_string(frequencies_hz_.size()) +
         " frequencies; allowed: one, or one a frequency");
  }
}

std::vector<BankFilter> Notch::design(double rate_hz) const {
  numerics::Sections sections;
  for (std::size_t i = 0; i < frequencies_hz_.size(); ++i) {
    require_below_nyquist("frequencies", frequencies_hz_[i], rate_hz);
    require_below_nyquist("width", widths_hz_[i], rate_hz);
    sections.push_back(
        value_or_fail(notch_section(angle(frequencies_hz_[i], rate_hz), angle(widths_hz_[i], rate_hz)), "frequencies"));
  }
  return {{"filter", std::move(sections)}};
}

std::string Notch::kind() const {
  return "notches at " + std::to_string(frequencies_hz_.size()) + (frequencies_hz_.size() == 1 ? " frequency" : " frequencies");
}

}  // namespace bodeflow::filters
