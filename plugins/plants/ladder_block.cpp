#include "ladder_block.hpp"

#include "ladder.hpp"
#include "model_parameters.hpp"
#include "model_record.hpp"

namespace bodeflow::plants {
namespace {

/// One value for all sections, or one each.
std::vector<double> each(const Parameters& p, const char* name, std::int64_t sections) {
  const auto& values = p.numbers(name);
  if (values.size() == 1) return std::vector<double>(static_cast<std::size_t>(sections), values.front());
  if (values.size() != static_cast<std::size_t>(sections))
    fail(std::string(name) + " has " + std::to_string(values.size()) + " values; allowed: one, or one for each of the " +
         std::to_string(sections) + " sections");
  return values;
}

}  // namespace

void LadderBlock::describe(Describe& d) {
  d.id("plants.ladder").summary("The model of a transformer winding: a ladder of coupled coil sections.").role("source");
  d.doc(
      "Sections in a row: inductance with resistance, a capacitance beside both, and from each node a capacitance with a "
      "conductance to earth. From the voltage at the first terminal to that of the last node, or, with `pick_up`, of a load "
      "behind a capacitance. Two states a section, one of the pick-up. Sections are not coupled magnetically.");
  d.reference(
      "E. P. Dick, C. C. Erven, Transformer diagnostic testing by frequency response analysis, 1978, "
      "doi:10.1109/TPAS.1978.354718");
  d.message_out(model).record_type("model").doc("a state space, continuous in time");
  d.required<std::int64_t>("sections").range(1, 200).doc("number of sections");
  d.parameter("inductance", std::vector<double>{1.5e-3}).unit("H").doc("of a section: one value, or one each");
  d.parameter("resistance", std::vector<double>{6.0}).unit("ohm").doc("in series with it");
  d.parameter("turn_capacitance", std::vector<double>{40e-12}).unit("F").doc("beside both");
  d.parameter("earth_capacitance", std::vector<double>{600e-12}).unit("F").doc("from the section's end to earth");
  d.parameter("earth_conductance", std::vector<double>{2e-6}).unit("S").doc("beside it");
  d.parameter("pick_up", 0.0).unit("F").range(0, 1).doc("capacitance from the last node to the load; 0: none");
  d.parameter("load", 50.0).unit("ohm").above(0.0).below(1e12).doc("behind the pick-up; its voltage is the output");
}

void LadderBlock::configure(const Parameters& p) {
  const std::int64_t n = p.integer("sections");
  const Ladder ladder{each(p, "inductance", n),
                      each(p, "resistance", n),
                      each(p, "turn_capacitance", n),
                      each(p, "earth_capacitance", n),
                      each(p, "earth_conductance", n),
                      p.number("pick_up"),
                      p.number("load")};
  system_ = value_or_fail(ladder_system(ladder));
}

void LadderBlock::finish(Io& io) {
  io.emit(model, known_model("plants.ladder", system_, {"terminal"}, {"output"}, {"V"}, {"V"}));
}

}  // namespace bodeflow::plants
