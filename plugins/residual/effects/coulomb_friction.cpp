#include "effects/coulomb_friction.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void CoulombFriction::describe(DescribeEffect& effect) {
  effect.id("residual.coulomb_friction")
      .summary("Dry friction acts against every movement and holds at rest")
      .doc(
          "F against the velocity, up to F at rest: spread over the velocity that F changes in a step, so that it sticks and "
          "does not chatter. Wrong where the contact is elastic before it slides (dahl_friction) or greater at rest "
          "(stribeck_friction).")
      .acts(Acts::law, {"bearing"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> CoulombFriction::parameters(const Situation& s) const {
  return {positive("coulomb_friction", s.place.reaction_unit).says("against the movement")};
}

std::vector<std::vector<double>> CoulombFriction::starts(const Situation& s) const {
  return {{0.03 * size_or_one(s.place.effort)}, {0.2 * size_or_one(s.place.effort)}};
}

std::string CoulombFriction::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "dry friction in the " + spoken(s.place.name) + ", " + quantity(value[0], std[0], s.place.reaction_unit) +
         " against every movement";
}

Reaction CoulombFriction::react(const double* p, const Signals& s, const double*, double*) const {
  const Shape sign = spread_sign(s.flow, s.gain * p[0]);
  return {p[0] * sign.value, p[0] * sign.slope, 0.0};
}

}  // namespace bodeflow::residual
