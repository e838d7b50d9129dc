#include "effects/resistance_drift.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void ResistanceDrift::describe(DescribeEffect& effect) {
  effect.id("residual.resistance_drift")
      .summary("The resistance changes evenly while the record is taken, for instance because it grows warm")
      .doc(
          "The reaction r t i is added, t since the record began. Every record begins anew at the value of the base model: wrong "
          "where the change goes on from record to record.")
      .acts(Acts::law, {"winding"})
      .nonstationary();
}

std::vector<FitParameter> ResistanceDrift::parameters(const Situation& s) const {
  const double size = 0.1 * resistance_of(s.place) / size_or_one(s.duration_s);
  return {real("resistance_drift", per(per(s.place.reaction_unit, s.place.flow_unit), "s"), size)
              .says("resistance gained in a second")};
}

std::vector<std::vector<double>> ResistanceDrift::starts(const Situation&) const { return {{0.0}}; }

std::string ResistanceDrift::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "resistance of the " + spoken(s.place.name) + " that changes by " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.flow_unit)) + " a second";
}

Reaction ResistanceDrift::react(const double* p, const Signals& s, const double*, double*) const {
  const double more = p[0] * s.time_s;
  return {more * s.flow, more, 0.0};
}

}  // namespace bodeflow::residual
