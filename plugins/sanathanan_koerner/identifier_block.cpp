#include "identifier_block.hpp"

#include "block_settings.hpp"
#include "emission.hpp"

namespace bodeflow::sanathanan_koerner {

void IdentifierBlock::describe_common(Describe& d) {
  d.message_in(response)
      .record_type("frequency_response")
      .doc("any number of inputs and outputs; the last that arrives is taken");
  d.message_in(repeat).record_type("frequency_response").optional().doc("the same measured again, to choose the order by");
  d.message_out(model).record_type("model").doc("at the end");
  d.message_out(order_scan).record_type("order_scan").doc("errors and criteria over the order, where the order is sought");
  d.message_out(residual).record_type("residual").doc("what the model leaves, line by line");
  describe_method(d);
  describe_selection(d);
}

void IdentifierBlock::read_common(const Parameters& p, Settings& s) {
  read_method(p, s);
  selection_ = read_selection(p);
}

void IdentifierBlock::receive(int port, const RecordView& record, Io&) {
  auto measured = read_measured(record, selection_);
  if (!measured) fail(measured.error().text);
  (port == response.index ? measured_ : repeated_) = std::move(*measured);
}

void IdentifierBlock::finish(Io& io) {
  if (!measured_) fail("no frequency response arrived");
  const Emission made = identified(id(), *measured_, repeated_, settings_for(*measured_));
  io.emit(model, made.model);
  if (made.order_scan) io.emit(order_scan, *made.order_scan);
  io.emit(residual, made.residual);
  for (const std::string& warning : made.warnings) log_warning(warning);
}

void IdentifierBlock::reset() {
  measured_.reset();
  repeated_.reset();
}

}  // namespace bodeflow::sanathanan_koerner
