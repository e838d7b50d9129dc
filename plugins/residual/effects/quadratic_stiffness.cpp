#include "effects/quadratic_stiffness.hpp"

#include <cmath>

#include "effects/words.hpp"

namespace bodeflow::residual {

void QuadraticStiffness::describe(DescribeEffect& effect) {
  effect.id("residual.quadratic_stiffness")
      .summary("The spring is stiffer to one side than to the other")
      .doc("k x^2 is added. A cubic spring around another rest position looks alike, and so does an offset of its sensor.")
      .acts(Acts::law, {"spring", "coupling"});
}

std::vector<FitParameter> QuadraticStiffness::parameters(const Situation& s) const {
  const double size = 0.1 * stiffness_of(s.place) / std::pow(size_or_one(s.place.stored), 1);
  return {real("quadratic_stiffness", per(s.place.reaction_unit, s.place.stored_unit, 2), size)
              .says("of the second power of the deflection")};
}

std::vector<std::vector<double>> QuadraticStiffness::starts(const Situation&) const { return {{0.0}}; }

std::string QuadraticStiffness::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "quadratic stiffness of the " + spoken(s.place.name) + ", " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.stored_unit, 2)) + ": " +
         digits(100.0 * value[0] * std::pow(s.place.stored, 1) / stiffness_of(s.place), 2) +
         " % of the linear force at the largest deflection";
}

Reaction QuadraticStiffness::react(const double* p, const Signals& s, const double*, double*) const {
  return {p[0] * s.stored * s.stored, 0.0, 2.0 * p[0] * s.stored};
}

}  // namespace bodeflow::residual
