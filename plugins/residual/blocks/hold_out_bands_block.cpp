#include "blocks/hold_out_bands_block.hpp"

#include "response/hold_out_bands.hpp"

namespace bodeflow::residual {

void HoldOutBands::describe(Describe& d) {
  d.id("residual.hold_out_bands")
      .summary("Shares out the lines of a measured response by bands: some to fit, some to select.")
      .doc(
          "Every `every`-th band of `band` octaves goes to `held_out`, the first after half as many others; the rest to `kept`. "
          "Neighbouring lines err alike, so that single lines left out would test nothing.");
  d.parameter("band", 1.0 / 3.0).unit("1").above(0.0).doc("width of the bands in octaves");
  d.parameter("every", std::int64_t{3}).range(2, 1000).doc("of how many bands one is held out");
  d.message_in(in).record_type("frequency_response");
  d.message_out(kept).record_type("frequency_response").doc("for the input `fit` of residual.trace");
  d.message_out(held_out).record_type("frequency_response").doc("for its input `select`");
}

void HoldOutBands::configure(const Parameters& p) {
  octaves_ = p.number("band");
  every_ = p.integer("every");
}

void HoldOutBands::receive(int, const RecordView& record, Io& io) {
  const auto response = records::read_response(record);
  if (!response) fail(response.error().text);
  const auto parts = hold_out_bands(*response, octaves_, static_cast<int>(every_));
  if (!parts) fail(parts.error().text);
  io.emit(kept, records::write_response(parts->kept));
  io.emit(held_out, records::write_response(parts->held_out));
}

}  // namespace bodeflow::residual
