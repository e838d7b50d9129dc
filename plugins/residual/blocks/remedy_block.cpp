#include "blocks/remedy_block.hpp"

#include <algorithm>
#include <array>
#include <bodeflow/parts.hpp>
#include <limits>

#include "model/simulate.hpp"
#include "trace/told_model.hpp"

namespace bodeflow::residual {
namespace {

constexpr std::array kKnobs{RemedyBlock::delay, RemedyBlock::dead_time, RemedyBlock::offset, RemedyBlock::friction};
static_assert(kKnobs.size() == std::size(kRemedies));

/// The output of the model by a constant input; not finite where it has none, or the base model is not there.
double steady_gain(const ToldModel& told, const Parts& parts) {
  const auto base = parts.base_model(told.base, told.declarations);
  const std::vector<double> known(base->known().size());
  const Eigen::VectorXd values =
      Eigen::Map<const Eigen::VectorXd>(told.after.data(), static_cast<Eigen::Index>(told.after.size()));
  return plant_response(*base, values, known, 0.0)(0, 0).real();
}

bool has(const ToldModel& told, const std::string& name) {
  return std::any_of(told.effects.begin(), told.effects.end(), [&](const NamedEffect& e) { return e.name == name; });
}

}  // namespace

void RemedyBlock::describe(Describe& d) {
  d.id("residual.remedy").summary("Turns the effects that a trace named into settings of the drive that make up for them.");
  d.doc(
      "Each output sends one parameter_change: the found parameter of that effect times its factor, or 0 where the effect was "
      "not "
      "found. delay: the command is sent earlier. dead_time: pulses are made longer or shorter by the sign of the current. "
      "offset: it is taken off the measurement; one of the input is, behind the plant's steady gain. friction: a torque by the "
      "sign of the speed. At `out` stands whether there is "
      "anything to switch on, for the `when` of the phase that measures again. Where several effects could not be told apart the "
      "first is remedied.");
  d.parameter("can", std::vector<std::string>{})
      .doc("what the drive can do, those of delay, dead_time, offset, coulomb_friction that it has a remedy for");
  for (std::size_t k = 0; k < kKnobs.size(); ++k) {
    const std::string name = kKnobs[k].name;
    d.parameter(name + ".parameter", kRemedies[k].parameter).doc("live parameter of the block that takes it");
    d.parameter(name + ".factor", 1.0).unit("").doc("what it is set to, over the parameter of the effect");
    d.parameter(name + ".unit", "").doc("of what it is set to, for the report");
    d.parameter(name + ".place", "").doc("only an effect at that place of the base model; empty: any");
  }
  d.message_in(in).record_type("trace");
  d.message_out(out).record_type("remedy").doc("exists, effects, values, units, sentence");
  for (const MessageOut& knob : kKnobs) d.message_out(knob).record_type("parameter_change");
}

void RemedyBlock::configure(const Parameters& p) {
  const std::vector<std::string> can = p.texts("can");
  knobs_.clear();
  for (std::size_t k = 0; k < kKnobs.size(); ++k) {
    const std::string name = kKnobs[k].name;
    knobs_.push_back({std::find(can.begin(), can.end(), kRemedies[k].effect) != can.end(), p.number(name + ".factor"),
                      p.text(name + ".parameter"), p.text(name + ".unit"), p.text(name + ".place")});
  }
  for (const std::string& effect : can) {
    if (std::any_of(std::begin(kRemedies), std::end(kRemedies), [&](const RemedyKind& r) { return r.effect == effect; }))
      continue;
    fail("can: no remedy for '" + effect + "', allowed: delay, dead_time, offset, coulomb_friction");
  }
}

void RemedyBlock::receive(int, const RecordView& record, Io& io) {
  const ToldModel told = read_told_model(record);
  std::vector<std::string> effects, units;
  std::vector<double> values;
  std::string words;
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    const Knob& knob = knobs_[k];
    std::optional<Remedied> found;
    if (knob.there) {
      const double gain = has(told, kRemedies[k].twin) ? steady_gain(told, parts()) : std::numeric_limits<double>::quiet_NaN();
      found = remedied(kRemedies[k], told.effects, knob.factor, knob.place, gain);
    }
    const double value = found ? found->value : 0.0;
    io.emit(kKnobs[k], RecordBuilder("parameter_change").set("parameter", knob.parameter).set("value", value));
    if (!found) continue;
    effects.push_back(found->effect);
    values.push_back(value);
    units.push_back(knob.unit);
    words += (words.empty() ? "" : ", ") + remedy_words(kRemedies[k], value, knob.unit);
  }
  RecordBuilder r("remedy");
  r.set("exists", !effects.empty()).set("effects", effects).set("values", values).set("units", units);
  r.set("sentence", effects.empty() ? std::string("Nothing was named that this drive has a remedy for.")
                                    : "Switched on in the drive: " + words + ".");
  io.emit(out, r);
}

}  // namespace bodeflow::residual
