#include "effects/cubic_damping.hpp"

#include <cmath>
#include <limits>

#include "effects/words.hpp"

namespace bodeflow::residual {

void CubicDamping::describe(DescribeEffect& effect) {
  effect.id("residual.cubic_damping")
      .summary("Damping that grows with the third power of the velocity")
      .doc("c v^3 against the movement.")
      .acts(Acts::law, {"bearing"});
}

std::vector<FitParameter> CubicDamping::parameters(const Situation& s) const {
  const double size = 0.1 * resistance_of(s.place) / std::pow(size_or_one(s.place.flow), 2);
  return {real("cubic_damping", per(s.place.reaction_unit, s.place.flow_unit, 3), size)
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("of the third power of the velocity")};
}

std::vector<std::vector<double>> CubicDamping::starts(const Situation&) const { return {{0.0}}; }

std::string CubicDamping::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "damping with the third power of the velocity in the " + spoken(s.place.name) + ", " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.flow_unit, 3));
}

Reaction CubicDamping::react(const double* p, const Signals& s, const double*, double*) const {
  const double square = s.flow * s.flow;
  return {p[0] * square * s.flow, 3.0 * p[0] * square, 0.0};
}

}  // namespace bodeflow::residual
