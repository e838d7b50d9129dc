#include "change_block.hpp"

#include "change_record.hpp"

namespace bodeflow::validation {

void ChangeBlock::describe(Describe& d) {
  d.id("validation.change").summary("Tells whether and where a plant has changed between two frequency responses.");
  d.doc(
      "The change of the response against its variance, by bands: changed, unchanged, or not decidable where a change of "
      "`relevant` would not be found. Models fitted to both responses give the resonances, paired as same, moved, new or "
      "vanished, with the deviations of their shifts. Correlation and the factors of DL/T 911 stand beside. Measurements of an "
      "unchanged plant differ by more than their noise: give one or more on `repeat`, or state `scatter`; otherwise a change is "
      "one beyond the noise alone, and the record says so. Variances that are too small make changes of everything.");
  d.reference(
      "H. Akcay, S. M. Islam, B. Ninness, Subspace based identification of power transformer models from frequency response "
      "data, "
      "1998");
  d.reference("DL/T 911-2004, Frequency response analysis on winding deformation of power transformers");
  d.message_in(before).record_type("frequency_response").doc("the reference; the last that arrives is taken");
  d.message_in(after).record_type("frequency_response").doc("of the same inputs and outputs; the last that arrives is taken");
  d.message_in(repeat).record_type("frequency_response").optional().doc("the reference measured again, each record one repeat");
  d.message_out(out).record_type("change").doc("at the end");
  d.parameter("scatter.relative", 0.0)
      .unit("1")
      .range(0, 1)
      .doc("by how much repeat tests differ: standard deviation of the complex value over its magnitude");
  d.parameter("scatter.absolute", 0.0).unit("").range(0, 1e30).doc("the same as an absolute value, in the unit of the response");
  d.parameter("bands", std::vector<double>{})
      .unit("Hz")
      .doc("edges of the bands, rising; default: band_count bands of as many lines");
  d.parameter("band_count", std::int64_t{6}).range(1, 100).doc("bands where no edges are given; at least 8 lines each");
  d.parameter("confidence", 0.99).unit("1").above(0.0).below(1.0).doc("of all bands and responses together");
  d.parameter("relevant", 0.1).unit("1").above(0.0).below(1e6).doc("relative change of a band that must not be missed");
  d.parameter("modes", true).doc("fit models and pair their resonances");
  d.parameter("order", std::int64_t{0}).range(0, 400).doc("poles of both models; 0: as many as the data support");
  d.parameter("highest_order", std::int64_t{30}).range(1, 400).doc("where the order is sought");
  d.parameter("pairing", 0.1)
      .unit("1")
      .above(0.0)
      .below(1.0)
      .doc("largest distance of two poles that are one mode, over their size");
}

void ChangeBlock::configure(const Parameters& p) {
  stated_ = Scatter{p.number("scatter.relative"), p.number("scatter.absolute"), {}};
  SpectrumSettings& s = settings_.spectrum;
  s.edges_hz = p.numbers("bands");
  if (s.edges_hz.size() == 1) fail("bands: one edge; needed: two or more, or none");
  for (std::size_t i = 1; i < s.edges_hz.size(); ++i)
    if (!(s.edges_hz[i] > s.edges_hz[i - 1])) fail("bands: the edges must rise");
  s.bands = p.integer("band_count");
  s.confidence = p.number("confidence");
  s.relevant = p.number("relevant");
  settings_.find_modes = p.boolean("modes");
  settings_.modes.order.reset();
  if (p.integer("order") > 0) settings_.modes.order = p.integer("order");
  settings_.modes.highest_order = p.integer("highest_order");
  settings_.apart = p.number("pairing");
}

void ChangeBlock::receive(int port, const RecordView& record, Io&) {
  auto read = records::read_response(record);
  const char* name = port == before.index ? "before" : port == after.index ? "after" : "repeat";
  if (!read) fail(std::string(name) + ": " + read.error().text);
  if (port == repeat.index) {
    repeats_.push_back(std::move(*read));
  } else {
    (port == before.index ? before_ : after_) = std::move(*read);
  }
}

void ChangeBlock::finish(Io& io) {
  if (!before_ || !after_) fail(std::string("no frequency response arrived on '") + (before_ ? "after" : "before") + "'");
  Scatter scatter = stated_;
  scatter.repeats = repeats_;
  const auto change = response_change(*before_, *after_, scatter, settings_);
  if (!change) fail(change.error().text);
  io.emit(out, write_change(*change, settings_));
  for (const std::string& warning : change->warnings) log_warning(warning);
}

void ChangeBlock::reset() {
  before_.reset();
  after_.reset();
  repeats_.clear();
}

}  // namespace bodeflow::validation
