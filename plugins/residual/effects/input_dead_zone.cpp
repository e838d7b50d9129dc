#include "effects/input_dead_zone.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void InputDeadZone::describe(DescribeEffect& effect) {
  effect.id("residual.input_dead_zone")
      .summary("The actuator does not answer small commands")
      .doc("What of u lies beyond +-d acts. A dead zone at the sensor or dry friction looks alike at one level of the input.")
      .acts(Acts::input)
      .rough();
}

std::vector<FitParameter> InputDeadZone::parameters(const Situation& s) const {
  return {positive("input_dead_zone", s.input_unit).says("largest command without an answer")};
}

std::vector<std::vector<double>> InputDeadZone::starts(const Situation& s) const {
  return {{0.02 * size_or_one(s.input_rms)}, {0.2 * size_or_one(s.input_rms)}};
}

std::string InputDeadZone::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "dead zone of the actuator, +-" + quantity(value[0], std[0], s.input_unit);
}

double InputDeadZone::map(const double* p, double x, double, double*) const { return beyond_gap(x, p[0]).value; }

}  // namespace bodeflow::residual
