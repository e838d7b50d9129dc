#include "effects/lugre_friction.hpp"

#include <algorithm>
#include <cmath>

#include "effects/words.hpp"

namespace bodeflow::residual {
namespace {

// Static friction of dry contacts is up to about twice the sliding one; more is another effect.
constexpr double kMostRise = 4.0;

}  // namespace

void LugreFriction::describe(DescribeEffect& effect) {
  effect.id("residual.lugre_friction")
      .summary("Friction of bristles that bend before they slide, and slide more easily the faster they do")
      .doc(
          "dz/dt = v - k |v| z / g(v), F = k z + d exp(-(v / w)^2) dz/dt, g(v) = Fc (1 + r exp(-(v / w)^2)); viscous friction is "
          "left to the base model. z is solved in closed form over a step of even velocity. The bristles' damping fades with the "
          "velocity, so that they never give energy. The rise r, its velocity and the damping are found only where the "
          "movement stops often.")
      .reference(
          "C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, A new model for control of systems with friction, IEEE "
          "Trans. Automatic Control 40 (1995) 419")
      .reference("H. Olsson et al., Friction models and friction compensation, European Journal of Control 4 (1998) 176")
      .acts(Acts::law, {"bearing"})
      .memory(2)
      .steps_per_sample(4);
}

std::vector<FitParameter> LugreFriction::parameters(const Situation& s) const {
  const std::string stiffness = s.place.stored_unit.empty() ? per(s.place.reaction_unit, factor(s.place.flow_unit) + " s")
                                                            : per(s.place.reaction_unit, s.place.stored_unit);
  return {positive("lugre_friction", s.place.reaction_unit).says("where it slides fast"),
          positive("lugre_stiffness", stiffness).says("of the bristles"),
          positive("lugre_rise", "1").between(0.0, kMostRise).says("by which share it is more where it begins to slide"),
          positive("lugre_velocity", s.place.flow_unit).says("at which a third of that is left"),
          positive("lugre_damping", per(s.place.reaction_unit, s.place.flow_unit)).says("of the bristles")};
}

std::vector<std::vector<double>> LugreFriction::starts(const Situation& s) const {
  const double effort = size_or_one(s.place.effort), stored = size_or_one(s.place.stored), flow = size_or_one(s.place.flow);
  std::vector<std::vector<double>> starts;
  for (const double path : {0.02, 0.3})
    starts.push_back({0.1 * effort, 0.1 * effort / (path * stored), 0.3, 0.1 * flow, 0.01 * effort / flow});
  return starts;
}

std::string LugreFriction::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "friction of bending bristles in the " + spoken(s.place.name) + ", " +
         quantity(value[0], std[0], s.place.reaction_unit) + " in movement, " + digits(value[0] * (1.0 + value[2]), 3) + " " +
         s.place.reaction_unit + " where it begins, after " + digits(value[0] / value[1], 2) + " " + s.place.stored_unit;
}

Reaction LugreFriction::react(const double* p, const Signals& s, const double* memory, double* next) const {
  const auto fading = [&](double velocity) { return std::exp(-(velocity / p[3]) * (velocity / p[3])); };
  const double mean = 0.5 * (memory[1] + s.flow), path = mean * s.step_s, towards = path >= 0.0 ? 1.0 : -1.0;
  const double steady = towards * p[0] * (1.0 + p[2] * fading(mean)) / p[1], rest = std::exp(-path / steady);
  const double bent = steady + (memory[0] - steady) * rest;
  next[0] = bent;
  next[1] = s.flow;
  const double fade = fading(s.flow), limit = p[0] * (1.0 + p[2] * fade) / p[1];
  const double damping = p[4] * fade, left = 1.0 - (s.flow >= 0.0 ? bent : -bent) / limit;
  const double slope = p[1] * 0.5 * s.step_s * std::max(0.0, 1.0 - bent / steady) + damping * std::max(0.0, left);
  return {p[1] * bent + damping * s.flow * left, slope, 0.0};
}

}  // namespace bodeflow::residual
