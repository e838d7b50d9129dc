#include "effects/backlash.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void Backlash::describe(DescribeEffect& effect) {
  effect.id("residual.backlash")
      .summary("The coupling has backlash: around its middle nothing touches and no torque passes")
      .doc(
          "Within +-g the stiffness is less by k, so the torque is less by k g beyond. Nothing touches where k is the whole "
          "stiffness: the fit says how much it is. The damping of the coupling stays within the gap.")
      .reference("M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash: a survey, Automatica 38 (2002) 1633")
      .acts(Acts::law, {"coupling"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> Backlash::parameters(const Situation& s) const {
  return {
      positive("backlash", s.place.stored_unit).says("half of the gap"),
      positive("backlash_stiffness", per(s.place.reaction_unit, s.place.stored_unit)).says("stiffness that is lost within it")};
}

std::vector<std::vector<double>> Backlash::starts(const Situation& s) const {
  const double stored = size_or_one(s.place.stored), stiffness = stiffness_of(s.place);
  return {{0.05 * stored, stiffness}, {0.3 * stored, stiffness}};
}

std::string Backlash::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "backlash of the " + spoken(s.place.name) + ", +-" + quantity(value[0], std[0], s.place.stored_unit) +
         ", within which the stiffness is less by " + quantity(value[1], std[1], per(s.place.reaction_unit, s.place.stored_unit));
}

Reaction Backlash::react(const double* p, const Signals& s, const double*, double*) const {
  const Shape beyond = beyond_gap(s.stored, p[0]);
  return {-p[1] * (s.stored - beyond.value), 0.0, -p[1] * (1.0 - beyond.slope)};
}

}  // namespace bodeflow::residual
