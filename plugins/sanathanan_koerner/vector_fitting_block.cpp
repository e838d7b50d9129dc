#include "vector_fitting_block.hpp"

namespace bodeflow::sanathanan_koerner {

void VectorFittingBlock::describe(Describe& d) {
  d.id("sanathanan_koerner.vector_fitting")
      .summary("Identifies a rational model of a frequency response, of any order, by relaxed vector fitting.")
      .role("identifier");
  d.doc(
      "The least-squares problem of sanathanan_koerner.model in partial fractions: poles are moved until they stay, then "
      "residues "
      "by least squares. The record `model` is a state space in real modal form, in continuous time. Needs poles to start from: "
      "linear spacing suits structures, which have most of their modes in the upper decade, logarithmic spacing a few poles over "
      "many decades; by default both are tried.");
  d.reference(
      "B. Gustavsen, A. Semlyen, Rational approximation of frequency domain responses by vector fitting, 1999, "
      "doi:10.1109/61.772353");
  d.reference("B. Gustavsen, Improving the pole relocating properties of vector fitting, 2006, doi:10.1109/TPWRD.2005.860281");
  describe_common(d);
  d.parameter("initial_poles", "auto")
      .choices({"auto", "linear", "logarithmic"})
      .doc(
          "spacing of the poles to start from over the part of the range where the response moves; auto: several, the best kept");
}

void VectorFittingBlock::configure(const Parameters& p) {
  Settings s;
  read_common(p, s);
  s.method = Method::vector_fitting;
  const std::string& spacing = p.text("initial_poles");
  s.initial_poles = spacing == "linear" ? Spacing::linear : spacing == "logarithmic" ? Spacing::logarithmic : Spacing::automatic;
  settings_ = s;
}

}  // namespace bodeflow::sanathanan_koerner
