#include "effects/cogging.hpp"

#include <cmath>

#include "effects/words.hpp"

namespace bodeflow::residual {

void Cogging::describe(DescribeEffect& effect) {
  effect.id("residual.cogging")
      .summary("A force that repeats over the position, as the teeth of a machine make it")
      .doc(
          "a sin(2 pi x / P) + b cos(2 pi x / P). Where the movement covers a small part of a period it acts like a spring. The "
          "period is found only from near: a fit may miss it.")
      .acts(Acts::law, {"bearing"})
      .steps_per_sample(4);
}

std::vector<FitParameter> Cogging::parameters(const Situation& s) const {
  const double size = 0.1 * size_or_one(s.place.effort);
  return {real("cogging_sine", s.place.reaction_unit, size).says("sine part"),
          real("cogging_cosine", s.place.reaction_unit, size).says("cosine part"),
          positive("cogging_period", s.place.stored_unit).says("distance after which it repeats")};
}

std::vector<std::vector<double>> Cogging::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double share : {2.0, 0.8, 0.3}) starts.push_back({0.0, 0.0, share * size_or_one(s.place.stored)});
  return starts;
}

std::string Cogging::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "cogging in the " + spoken(s.place.name) + ", " +
         quantity(std::hypot(value[0], value[1]), std::hypot(std[0], std[1]), s.place.reaction_unit) + " every " +
         digits(value[2], 4) + " " + s.place.stored_unit;
}

Reaction Cogging::react(const double* p, const Signals& s, const double*, double*) const {
  constexpr double kTurn = 6.283185307179586;
  const double per_length = kTurn / p[2], angle = per_length * s.stored, sine = std::sin(angle), cosine = std::cos(angle);
  return {p[0] * sine + p[1] * cosine, 0.0, per_length * (p[0] * cosine - p[1] * sine)};
}

}  // namespace bodeflow::residual
