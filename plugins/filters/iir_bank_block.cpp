#include "iir_bank_block.hpp"

#include "iir_parameters.hpp"
#include "records/signals.hpp"

namespace bodeflow::filters {
namespace {

using numerics::Pass;
using records::short_number;

constexpr double kAtNyquist = 1e-9;  // relative: an upper edge that is the Nyquist frequency

}  // namespace

void IirBank::describe(Describe& d) {
  d.id("filters.iir_bank").summary("Many filters of a classical family side by side, one band each.").cost_ns(20);
  d.doc(
      "Every channel of the input becomes K channels, one a row of `bands`, in this order: all bands of the first channel, then "
      "all "
      "of the second ... A band from 0 on is a low pass, a band up to the Nyquist frequency a high pass. Eight outputs at a time "
      "go "
      "through the processor's vector unit; each has the bits that filters.iir gives for it alone. Else as filters.iir.");
  d.required<Matrix>("bands").doc("one row a band, lower and upper edge in Hz; 0 and the Nyquist frequency leave a side open");
  describe_family(d);
  describe_ports(d);
}

void IirBank::configure(const Parameters& p) {
  design_ = read_family(p);
  bands_hz_ = p.matrix("bands");
  if (bands_hz_.rows == 0 || bands_hz_.columns != 2) fail("bands needs at least one row of two frequencies: [[low, high], ...]");
}

std::vector<BankFilter> IirBank::design(double rate_hz) const {
  std::vector<BankFilter> filters;
  for (std::size_t i = 0; i < bands_hz_.rows; ++i) {
    const double low = bands_hz_(i, 0), high = bands_hz_(i, 1);
    const std::string row = "row " + std::to_string(i + 1) + " of bands";
    const bool from_zero = low == 0, to_end = std::abs(high - 0.5 * rate_hz) <= kAtNyquist * rate_hz;
    if (!(low < high)) fail(row + ": " + short_number(low) + " to " + short_number(high) + " Hz; allowed: a rising band");
    if (from_zero && to_end) fail(row + " is all that there is, 0 to the Nyquist frequency: it needs no filter");
    numerics::IirDesign d = design_;
    if (!from_zero) require_below_nyquist(row, low, rate_hz);
    if (!to_end) require_below_nyquist(row, high, rate_hz);
    d.pass = from_zero ? Pass::low : to_end ? Pass::high : Pass::band;
    d.edges = {angle(from_zero ? high : low, rate_hz), angle(high, rate_hz)};
    filters.push_back(
        {short_number(low) + "-" + short_number(high) + " Hz", value_or_fail(numerics::design_iir(d), row).sections});
  }
  return filters;
}

std::string IirBank::kind() const { return std::to_string(bands_hz_.rows) + " bands, " + family_text(design_); }

}  // namespace bodeflow::filters
