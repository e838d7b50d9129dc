#include "model_block.hpp"

#include "block_settings.hpp"

namespace bodeflow::sanathanan_koerner {

void ModelBlock::describe(Describe& d) {
  d.id("sanathanan_koerner.model")
      .summary("Identifies a rational model of a frequency response, of any order, by iterated linear least squares.")
      .role("identifier");
  d.doc(
      "Least squares of weight * (G - n/d) by the Sanathanan-Koerner iteration in orthonormal polynomials, relaxed, with "
      "unstable "
      "poles "
      "reflected; several inputs and outputs share d. Orders of some hundred poles over several decades come out to rounding "
      "from "
      "data without noise. The record `model` is a state space made without polynomial coefficients. The fixed point of the "
      "iteration is near, not at, the least-squares minimum: `refine: true` goes there. A model with more poles than the data "
      "support follows "
      "the noise.");
  d.reference(
      "C. K. Sanathanan, J. Koerner, Transfer function synthesis as a ratio of two complex polynomials, 1963, "
      "doi:10.1109/TAC.1963.1105517");
  d.reference("D. A. Jue, Frequency domain system identification with a rational, multi-band, curve-fitting approach, 1998");
  d.reference(
      "P. D. Brubeck, Y. Nakatsukasa, L. N. Trefethen, Vandermonde with Arnoldi, SIAM Review 63, 2021, doi:10.1137/19M130100X");
  describe_common(d);
  d.parameter("domain", "s").choices({"s", "z"}).doc("a model in s, or in z at the sample rate of the response");
  describe_prewarp(d);
  d.parameter("basis", "orthonormal")
      .choices({"orthonormal", "monomial"})
      .doc("monomial: the method as Jue prints it, powers of 1/z without relaxation, the best stable iterate; for comparison");
  d.parameter("iteration_weight", "denominator")
      .choices({"denominator", "square_root"})
      .doc("of an iterate: 1/|d| of the one before, or Jue's 1/sqrt|d|, which favours lines off the resonances and costs error");
}

void ModelBlock::configure(const Parameters& p) {
  Settings s;
  read_common(p, s);
  in_z_ = p.text("domain") == "z";
  s.prewarp_rad_s = read_prewarp(p);
  if (in_z_ && s.prewarp_rad_s) fail("prewarp is for domain: s; a model in z has its lines on the circle");
  s.method = p.text("basis") == "monomial" ? Method::monomial : Method::arnoldi;
  s.weight_exponent = p.text("iteration_weight") == "square_root" ? 0.5 : 1.0;
  settings_ = s;
}

Settings ModelBlock::settings_for(const Measured& measured) const {
  Settings s = settings_;
  if (!in_z_) return s;
  if (measured.sample_time_s == 0.0) fail("domain: z needs a response with its sample rate");
  s.sample_time_s = measured.sample_time_s;
  return s;
}

}  // namespace bodeflow::sanathanan_koerner
