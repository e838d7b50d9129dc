#include "effects/stop.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void Stop::describe(DescribeEffect& effect) {
  effect.id("residual.stop")
      .summary("Beyond a clearance the spring touches a second one, or a stop")
      .doc(
          "Beyond +-g the force k (x -+ g) is added. Seen only above a level of the input. Wrong where the clearance differs to "
          "both sides, or the impact itself loses energy.")
      .acts(Acts::law, {"spring"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> Stop::parameters(const Situation& s) const {
  return {positive("stop_gap", s.place.stored_unit).says("clearance to either side"),
          positive("stop_stiffness", per(s.place.reaction_unit, s.place.stored_unit)).says("stiffness beyond it")};
}

std::vector<std::vector<double>> Stop::starts(const Situation& s) const {
  const double stored = size_or_one(s.place.stored), stiffness = stiffness_of(s.place);
  return {{0.35 * stored, 0.5 * stiffness}, {0.75 * stored, 2.0 * stiffness}};
}

std::string Stop::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "stop beyond +-" + quantity(value[0], std[0], s.place.stored_unit) + " of the " + spoken(s.place.name) + ", stiffness " +
         quantity(value[1], std[1], per(s.place.reaction_unit, s.place.stored_unit));
}

Reaction Stop::react(const double* p, const Signals& s, const double*, double*) const {
  const Shape beyond = beyond_gap(s.stored, p[0]);
  return {p[1] * beyond.value, 0.0, p[1] * beyond.slope};
}

}  // namespace bodeflow::residual
