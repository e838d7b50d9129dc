#include "effects/quadratic_damping.hpp"

#include <cmath>
#include <limits>

#include "effects/words.hpp"

namespace bodeflow::residual {

void QuadraticDamping::describe(DescribeEffect& effect) {
  effect.id("residual.quadratic_damping")
      .summary("Drag that grows with the square of the velocity, as in air or oil")
      .doc("c v |v| against the movement.")
      .acts(Acts::law, {"bearing"});
}

std::vector<FitParameter> QuadraticDamping::parameters(const Situation& s) const {
  const double size = 0.1 * resistance_of(s.place) / std::pow(size_or_one(s.place.flow), 1);
  return {real("quadratic_damping", per(s.place.reaction_unit, s.place.flow_unit, 2), size)
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("of the second power of the velocity")};
}

std::vector<std::vector<double>> QuadraticDamping::starts(const Situation&) const { return {{0.0}}; }

std::string QuadraticDamping::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "damping with the second power of the velocity in the " + spoken(s.place.name) + ", " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.flow_unit, 2));
}

Reaction QuadraticDamping::react(const double* p, const Signals& s, const double*, double*) const {
  const double speed = std::abs(s.flow);
  return {p[0] * s.flow * speed, 2.0 * p[0] * speed, 0.0};
}

}  // namespace bodeflow::residual
