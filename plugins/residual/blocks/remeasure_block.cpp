#include "blocks/remeasure_block.hpp"

#include <algorithm>
#include <bodeflow/parts.hpp>

#include "periodic/periodic_measurement.hpp"
#include "records/record_arrays.hpp"
#include "records/record_copy.hpp"
#include "records/signals.hpp"
#include "trace/held_out.hpp"

namespace bodeflow::residual {
namespace {

template <class T>
T valid(Expected<T> result) {
  if (!result) fail(result.error().text);
  return std::move(*result);
}

PartsInReach reach(const Parts& parts) {
  return {[&parts](const std::string& id, const std::vector<std::string>& d) { return parts.base_model(id, d); },
          [&parts](const std::string& name) {
            for (EffectDescription& what : parts.effects())
              if (what.name() == name) return CatalogueEntry{what, parts.effect(what.id)};
            fail("no plugin gives the effect '" + name + "', of which the trace tells");
          }};
}

std::string words(const HeldOutError& e, double before, const std::string& unit) {
  const auto amount = [&unit](double v) { return records::short_number(v, 4) + " " + unit; };
  std::string text = "Measured again, the model without the effect has an error of " + amount(e.error) + " in place of " +
                     amount(before) + "; the noise alone leaves " + amount(e.floor) + ".";
  return text + (e.at_floor() ? " Nothing but noise is left." : "");
}

}  // namespace

void Remeasure::describe(Describe& d) {
  d.id("residual.remeasure")
      .summary("Tells the error of the base model on a record that was measured with the remedy switched on.");
  d.doc(
      "The model of the trace without the effects that the drive now makes up for, with the base parameters that the trace found "
      "beside them, on the new record: nothing is fitted. If the effect was the cause and the remedy is good, the error falls to "
      "that of the model with the effect on the record before. The trace goes out again with error_remedied, excess_remedied "
      "and the residual.");
  d.message_in(trace).record_type("trace");
  d.message_in(remedy).record_type("remedy").doc("what was switched on");
  d.message_in(in).record_type("recording").doc("measured with it, periodic");
  d.message_out(out).record_type("trace").doc("the trace, completed");
}

void Remeasure::receive(int port, const RecordView& record, Io&) {
  if (port == trace.index) {
    told_ = read_told_model(record);
    whole_ = records::copy_of(record);
    before_ = record.number("error_before").value_or(0.0);
  } else if (port == remedy.index) {
    const auto effects = record.texts("effects");
    if (!effects) fail("the remedy has no list 'effects'");
    remedy_ = Remedy{{effects->begin(), effects->end()}, std::string(record.text("sentence").value_or(""))};
  } else {
    auto recording = records::read_recording(record);
    if (!recording) fail(recording.error().text);
    recording_ = std::move(*recording);
  }
}

/// The effects of the model that were remedied: of each name the first.
std::vector<std::size_t> Remeasure::remedied() const {
  std::vector<std::size_t> numbers;
  for (const std::string& name : remedy_->effects) {
    const auto at = std::find_if(told_->effects.begin(), told_->effects.end(), [&](const auto& e) { return e.name == name; });
    if (at == told_->effects.end()) fail("the remedy is for '" + name + "', which the trace does not name");
    numbers.push_back(static_cast<std::size_t>(at - told_->effects.begin()));
  }
  return numbers;
}

void Remeasure::finish(Io& io) {
  if (!told_) fail("no trace arrived at 'trace'");
  if (!remedy_) fail("no remedy arrived at 'remedy'");
  if (!recording_) fail("no recording arrived at 'in'");
  const Parts all = parts();
  const RebuiltModel rebuilt = rebuild(*told_, reach(all), remedied());
  const BaseModel& base = *rebuilt.model.base;
  const auto record = valid(periodic_measurement(*recording_, "remedied", std::vector<double>(base.known().size()), base));
  const HeldOut held_out = valid(hold_out(rebuilt.model, rebuilt.values, *record));
  const HeldOutError error = record->error(held_out.residual);
  const ResidualPicture picture = record->picture(held_out.residual);
  RecordBuilder r = *whole_;
  r.set("error_remedied", error.error).set("excess_remedied", error.excess());
  r.set("noise_floor_remedied", error.floor).set("at_floor_remedied", error.at_floor());
  r.set("remedy", remedy_->sentence).set("remedied_effects", remedy_->effects);
  r.set("sentence_remedied", words(error, before_, told_->unit));
  records::put_list<double>(r, "remedied_at", picture.axis == "time" ? "s" : "Hz", picture.at);
  records::put_list<double>(r, "residual_remedied", told_->unit, picture.residual);
  io.emit(out, r);
}

void Remeasure::reset() {
  told_.reset();
  whole_.reset();
  remedy_.reset();
  recording_.reset();
}

}  // namespace bodeflow::residual
