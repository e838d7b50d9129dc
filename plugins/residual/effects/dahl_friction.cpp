#include "effects/dahl_friction.hpp"

#include <cmath>

#include "effects/words.hpp"

namespace bodeflow::residual {

void DahlFriction::describe(DescribeEffect& effect) {
  effect.id("residual.dahl_friction")
      .summary("Friction that gives way elastically before it slides, as bearings do in small movements")
      .doc(
          "dF/dx = k (1 - F / Fc sign(v)), solved in closed form over each step. It depends on the path, not on the velocity. "
          "Wrong where friction falls with the velocity (lugre_friction), and loops within loops do not close exactly.")
      .reference("P. R. Dahl, A solid friction model, Aerospace Corporation TOR-0158(3107-18)-1, 1968")
      .acts(Acts::law, {"bearing"})
      .memory(2)
      .steps_per_sample(4);
}

std::vector<FitParameter> DahlFriction::parameters(const Situation& s) const {
  const std::string stiffness = s.place.stored_unit.empty() ? per(s.place.reaction_unit, factor(s.place.flow_unit) + " s")
                                                            : per(s.place.reaction_unit, s.place.stored_unit);
  return {positive("dahl_friction", s.place.reaction_unit).says("where it slides"),
          positive("dahl_stiffness", stiffness).says("of the contact at rest")};
}

std::vector<std::vector<double>> DahlFriction::starts(const Situation& s) const {
  const double effort = size_or_one(s.place.effort), stored = size_or_one(s.place.stored);
  std::vector<std::vector<double>> starts;
  for (const double path : {0.02, 0.3}) starts.push_back({0.1 * effort, 0.1 * effort / (path * stored)});
  return starts;
}

std::string DahlFriction::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "friction in the " + spoken(s.place.name) + " that gives way before it slides, " +
         quantity(value[0], std[0], s.place.reaction_unit) + " after " + digits(value[0] / value[1], 2) + " " +
         s.place.stored_unit;
}

Reaction DahlFriction::react(const double* p, const Signals& s, const double* memory, double* next) const {
  const double path = 0.5 * (memory[1] + s.flow) * s.step_s, towards = path >= 0.0 ? 1.0 : -1.0;
  const double share = towards + (memory[0] - towards) * std::exp(-std::abs(path) * p[1] / p[0]);
  next[0] = share;
  next[1] = s.flow;
  return {p[0] * share, 0.5 * s.step_s * p[1] * (1.0 - towards * share), 0.0};
}

}  // namespace bodeflow::residual
