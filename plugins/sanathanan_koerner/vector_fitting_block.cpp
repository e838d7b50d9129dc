#include "vector_fitting_block.hpp"

#include "block_settings.hpp"
#include "emission.hpp"

namespace bodeflow::sanathanan_koerner {

void VectorFittingBlock::describe(Describe& d) {
  d.id("sanathanan_koerner.vector_fitting")
      .summary("Identifies a rational model of a frequency response, of any order, by relaxed vector fitting.")
      .role("identifier");
  d.doc(
      "The least-squares problem of sanathanan_koerner.model in partial fractions: poles are moved until they stay, then "
      "residues "
      "by least squares. The record `model` is a state space in real modal form, in continuous time. Needs poles to start from: "
      "linear spacing over the range is the default, since structures have most of their modes in the upper decade and poles "
      "that start "
      "elsewhere must wander there; logarithmic spacing suits a few poles over many decades.");
  d.reference(
      "B. Gustavsen, A. Semlyen, Rational approximation of frequency domain responses by vector fitting, 1999, "
      "doi:10.1109/61.772353");
  d.reference("B. Gustavsen, Improving the pole relocating properties of vector fitting, 2006, doi:10.1109/TPWRD.2005.860281");
  d.message_in(response)
      .record_type("frequency_response")
      .doc("any number of inputs and outputs; the last that arrives is taken");
  d.message_in(repeat).record_type("frequency_response").optional().doc("the same measured again, to choose the order by");
  d.message_out(model).record_type("model").doc("at the end");
  d.message_out(order_scan).record_type("order_scan").doc("errors and criteria over the order, where the order is sought");
  d.message_out(residual).record_type("residual").doc("what the model leaves, line by line");
  describe_method(d);
  describe_selection(d);
  d.parameter("initial_poles", "linear")
      .choices({"linear", "logarithmic"})
      .doc("how the poles to start from are spaced over the range of the lines");
}

void VectorFittingBlock::configure(const Parameters& p) {
  Settings s;
  read_method(p, s);
  selection_ = read_selection(p);
  s.method = Method::vector_fitting;
  s.initial_poles = p.text("initial_poles") == "logarithmic" ? Spacing::logarithmic : Spacing::linear;
  settings_ = s;
}

void VectorFittingBlock::receive(int port, const RecordView& record, Io&) {
  auto measured = read_measured(record, selection_);
  if (!measured) fail(measured.error().text);
  (port == response.index ? measured_ : repeated_) = std::move(*measured);
}

void VectorFittingBlock::finish(Io& io) {
  if (!measured_) fail("no frequency response arrived");
  const Emission made = identified("sanathanan_koerner.vector_fitting", *measured_, repeated_, settings_);
  io.emit(model, made.model);
  if (made.order_scan) io.emit(order_scan, *made.order_scan);
  io.emit(residual, made.residual);
  for (const std::string& warning : made.warnings) log_warning(warning);
}

void VectorFittingBlock::reset() {
  measured_.reset();
  repeated_.reset();
}

}  // namespace bodeflow::sanathanan_koerner
