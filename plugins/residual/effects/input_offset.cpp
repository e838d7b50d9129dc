#include "effects/input_offset.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void InputOffset::describe(DescribeEffect& effect) {
  effect.id("residual.input_offset")
      .summary("The actuator adds a constant to its command, or a constant load acts")
      .doc("u + b. On a linear plant that passes a constant it looks like an offset of the sensor.")
      .acts(Acts::input)
      .constant();
}

std::vector<FitParameter> InputOffset::parameters(const Situation& s) const {
  return {real("input_offset", s.input_unit, size_or_one(s.input_rms)).says("added to the input")};
}

std::vector<std::vector<double>> InputOffset::starts(const Situation&) const { return {{0.0}}; }

std::string InputOffset::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "offset of the actuator, " + quantity(value[0], std[0], s.input_unit);
}

double InputOffset::map(const double* p, double x, double, double*) const { return x + p[0]; }

}  // namespace bodeflow::residual
