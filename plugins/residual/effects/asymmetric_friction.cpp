#include "effects/asymmetric_friction.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void AsymmetricFriction::describe(DescribeEffect& effect) {
  effect.id("residual.asymmetric_friction")
      .summary("Dry friction acts against every movement, and more in one direction")
      .doc(
          "F forth, G back, between them at rest. It is dry friction of (F + G) / 2 and a constant load of (F - G) / 2 while it "
          "moves.")
      .acts(Acts::law, {"bearing"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> AsymmetricFriction::parameters(const Situation& s) const {
  return {positive("friction_forth", s.place.reaction_unit).says("against movement in the positive direction"),
          positive("friction_back", s.place.reaction_unit).says("against movement in the negative direction")};
}

std::vector<std::vector<double>> AsymmetricFriction::starts(const Situation& s) const {
  const double effort = size_or_one(s.place.effort);
  return {{0.03 * effort, 0.03 * effort}, {0.2 * effort, 0.2 * effort}};
}

std::string AsymmetricFriction::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "dry friction in the " + spoken(s.place.name) + ", " + quantity(value[0], std[0], s.place.reaction_unit) +
         " forth and " + quantity(value[1], std[1], s.place.reaction_unit) + " back";
}

Reaction AsymmetricFriction::react(const double* p, const Signals& s, const double*, double*) const {
  const double force = s.flow > 0.0 ? p[0] : p[1];
  const Shape sign = spread_sign(s.flow, s.gain * force);
  return {force * sign.value, force * sign.slope, 0.0};
}

}  // namespace bodeflow::residual
