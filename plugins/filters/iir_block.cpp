#include "iir_block.hpp"

#include "iir_parameters.hpp"

namespace bodeflow::filters {
namespace {

using numerics::Pass;

bool is_band(Pass pass) { return pass == Pass::band || pass == Pass::stop; }

Pass read_pass(const std::string& name) {
  if (name == "high_pass") return Pass::high;
  if (name == "band_pass") return Pass::band;
  return name == "band_stop" ? Pass::stop : Pass::low;
}

}  // namespace

void Iir::describe(Describe& d) {
  d.id("filters.iir").summary("Low-pass, high-pass, band-pass or band-stop filter of a classical family.").cost_ns(10);
  d.doc(
      "Butterworth, Chebyshev (I and II), Bessel and elliptic filters as second-order sections in transposed direct form II, the "
      "same on every channel. "
      "bilinear: z = (2 + s h) / (2 - s h), edges pre-warped, so they lie where they are asked for; towards the Nyquist "
      "frequency "
      "the response is compressed, and a Bessel filter's delay is constant only well below it. impulse_invariance: the impulse "
      "response is h times the sampled one of the continuous-time filter; for low-pass and band-pass filters of butterworth, "
      "chebyshev_1 and bessel up to order 8 that are below 0.1 at the Nyquist frequency.");
  d.parameter("pass", "low_pass").choices({"low_pass", "high_pass", "band_pass", "band_stop"}).doc("what it lets through");
  d.required<std::vector<double>>("edges").unit("Hz").doc("one frequency, two rising ones of band filters");
  describe_family(d);
  describe_ports(d);
}

void Iir::configure(const Parameters& p) {
  design_ = read_family(p);
  design_.pass = read_pass(p.text("pass"));
  edges_hz_ = p.numbers("edges");
  const std::size_t needed = is_band(design_.pass) ? 2 : 1;
  if (edges_hz_.size() != needed) {
    fail("edges has " + std::to_string(edges_hz_.size()) + " frequencies, a " + p.text("pass") + " filter has " +
         std::to_string(needed));
  }
}

std::vector<BankFilter> Iir::design(double rate_hz) const {
  numerics::IirDesign d = design_;
  for (std::size_t i = 0; i < edges_hz_.size(); ++i) {
    require_below_nyquist("edges", edges_hz_[i], rate_hz);
    d.edges[i] = angle(edges_hz_[i], rate_hz);
  }
  return {{"filter", value_or_fail(numerics::design_iir(d), "edges").sections}};
}

std::string Iir::kind() const { return family_text(design_); }

}  // namespace bodeflow::filters
