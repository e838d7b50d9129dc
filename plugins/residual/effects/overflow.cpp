#include "effects/overflow.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void Overflow::describe(DescribeEffect& effect) {
  effect.id("residual.overflow")
      .summary("The tank runs over: above a level its water leaves another way")
      .doc(
          "Above the level h the outflow c (x - h) is added; a large c holds the level at h. Where the water goes is said by the "
          "base model.")
      .acts(Acts::law, {"tank"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> Overflow::parameters(const Situation& s) const {
  return {positive("overflow_level", s.place.stored_unit).says("above which it runs over"),
          positive("overflow_rate", per(s.place.reaction_unit, s.place.stored_unit)).says("outflow for a level above that")};
}

std::vector<std::vector<double>> Overflow::starts(const Situation& s) const {
  const double stored = size_or_one(s.place.stored), flow = size_or_one(s.place.effort > 0.0 ? s.place.effort : s.place.flow);
  return {{0.95 * stored, flow / (0.1 * stored)}, {0.8 * stored, flow / (0.1 * stored)}};
}

std::string Overflow::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "overflow of the " + spoken(s.place.name) + " above " + quantity(value[0], std[0], s.place.stored_unit);
}

Reaction Overflow::react(const double* p, const Signals& s, const double*, double*) const {
  const bool over = s.stored > p[0];
  return {over ? p[1] * (s.stored - p[0]) : 0.0, 0.0, over ? p[1] : 0.0};
}

}  // namespace bodeflow::residual
