#include "effects/stiffness_drift.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void StiffnessDrift::describe(DescribeEffect& effect) {
  effect.id("residual.stiffness_drift")
      .summary("The stiffness changes evenly while the record is taken, for instance because it grows warm")
      .doc(
          "The reaction r t x is added, t since the record began. Every record begins anew at the value of the base model: wrong "
          "where the change goes on from record to record.")
      .acts(Acts::law, {"spring"})
      .nonstationary();
}

std::vector<FitParameter> StiffnessDrift::parameters(const Situation& s) const {
  const double size = 0.1 * stiffness_of(s.place) / size_or_one(s.duration_s);
  return {real("stiffness_drift", per(per(s.place.reaction_unit, s.place.stored_unit), "s"), size)
              .says("stiffness gained in a second")};
}

std::vector<std::vector<double>> StiffnessDrift::starts(const Situation&) const { return {{0.0}}; }

std::string StiffnessDrift::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "stiffness of the " + spoken(s.place.name) + " that changes by " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.stored_unit)) + " a second";
}

Reaction StiffnessDrift::react(const double* p, const Signals& s, const double*, double*) const {
  const double more = p[0] * s.time_s;
  return {more * s.stored, 0.0, more};
}

}  // namespace bodeflow::residual
