#include "effects/cubic_stiffness.hpp"

#include <cmath>

#include "effects/words.hpp"

namespace bodeflow::residual {

void CubicStiffness::describe(DescribeEffect& effect) {
  effect.id("residual.cubic_stiffness")
      .summary("The spring becomes stiffer or softer the further it is deflected")
      .doc(
          "k x^3 is added: k above 0 hardens, below 0 softens. Wrong far beyond the deflections measured, where a soft spring "
          "would push away.")
      .acts(Acts::law, {"spring", "coupling"});
}

std::vector<FitParameter> CubicStiffness::parameters(const Situation& s) const {
  const double size = 0.1 * stiffness_of(s.place) / std::pow(size_or_one(s.place.stored), 2);
  return {real("cubic_stiffness", per(s.place.reaction_unit, s.place.stored_unit, 3), size)
              .says("of the third power of the deflection")};
}

std::vector<std::vector<double>> CubicStiffness::starts(const Situation&) const { return {{0.0}}; }

std::string CubicStiffness::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "cubic stiffness of the " + spoken(s.place.name) + ", " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.stored_unit, 3)) + ": " +
         digits(100.0 * value[0] * std::pow(s.place.stored, 2) / stiffness_of(s.place), 2) +
         " % of the linear force at the largest deflection";
}

Reaction CubicStiffness::react(const double* p, const Signals& s, const double*, double*) const {
  const double square = s.stored * s.stored;
  return {p[0] * square * s.stored, 0.0, 3.0 * p[0] * square};
}

}  // namespace bodeflow::residual
