#include "effects/stribeck_friction.hpp"

#include <algorithm>
#include <cmath>

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {
namespace {

// Static friction of dry contacts is up to about twice the sliding one; more is another effect.
constexpr double kMostRise = 4.0;

}  // namespace

void StribeckFriction::describe(DescribeEffect& effect) {
  effect.id("residual.stribeck_friction")
      .summary("Dry friction that is greater at rest than in movement")
      .doc(
          "F (1 + r exp(-(v / w)^2)) against the velocity, spread over the velocity that it changes in a step. Wrong where the "
          "contact is elastic before it slides (lugre_friction).")
      .reference(
          "B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and compensation methods for "
          "the control of machines with friction, Automatica 30 (1994) 1083")
      .acts(Acts::law, {"bearing"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> StribeckFriction::parameters(const Situation& s) const {
  return {positive("coulomb_friction", s.place.reaction_unit).says("against the movement"),
          positive("friction_rise", "1").between(0.0, kMostRise).says("by which share it is more at rest"),
          positive("stribeck_velocity", s.place.flow_unit).says("at which a third of the rest is left")};
}

std::vector<std::vector<double>> StribeckFriction::starts(const Situation& s) const {
  const double effort = size_or_one(s.place.effort), flow = size_or_one(s.place.flow);
  return {{0.03 * effort, 0.5, 0.1 * flow}, {0.2 * effort, 0.5, 0.1 * flow}, {0.2 * effort, 0.5, 0.02 * flow}};
}

std::string StribeckFriction::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "friction in the " + spoken(s.place.name) + ", " + quantity(value[0], std[0], s.place.reaction_unit) +
         " in movement and " + digits(value[0] * (1.0 + value[1]), 3) + " " + s.place.reaction_unit + " at rest";
}

Reaction StribeckFriction::react(const double* p, const Signals& s, const double*, double*) const {
  // Not narrower than what keeps one solution in a step: the fall stays below half of 1 / gain.
  const double more = p[0] * p[1], width = std::max(p[2], 2.0 * s.gain * more), ratio = s.flow / width;
  const double rest = width > 0.0 ? more * std::exp(-ratio * ratio) : 0.0, force = p[0] + rest;
  const Shape sign = spread_sign(s.flow, s.gain * (p[0] + more));
  const double fall = width > 0.0 ? -2.0 * ratio / width * rest : 0.0;
  return {force * sign.value, force * sign.slope + fall * sign.value, 0.0};
}

}  // namespace bodeflow::residual
