#include "effects/damping_step.hpp"

#include "effects/instants.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void DampingStep::describe(DescribeEffect& effect) {
  effect.id("residual.damping_step")
      .summary("The damping jumps while the record is taken")
      .doc("From an instant on, damping is added. In every record at the same time since it began: wrong where it happens once.")
      .acts(Acts::law, {"bearing"})
      .nonstationary();
}

std::vector<FitParameter> DampingStep::parameters(const Situation& s) const {
  return {real("damping_step", per(s.place.reaction_unit, s.place.flow_unit), 0.1 * resistance_of(s.place))
              .says("by how much it jumps"),
          instant(s)};
}

std::vector<std::vector<double>> DampingStep::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double at : likely_instants(s)) starts.push_back({0.0, at});
  return starts;
}

std::string DampingStep::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "damping of the " + spoken(s.place.name) + " that jumps by " +
         quantity(value[0], std[0], per(s.place.reaction_unit, s.place.flow_unit)) + " " + digits(value[1], 4) +
         " s after the record began";
}

Reaction DampingStep::react(const double* p, const Signals& s, const double*, double*) const {
  const double more = p[0] * after(p[1], s.time_s, s.step_s);
  return {more * s.flow, more, 0.0};
}

}  // namespace bodeflow::residual
