#include "effects/input_nonlinearity.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void InputNonlinearity::describe(DescribeEffect& effect) {
  effect.id("residual.input_nonlinearity")
      .summary("The characteristic of the actuator is curved")
      .doc(
          "u + a u^2 + b u^3. A gain error is no part of it: that merges with the base model. Wrong far beyond the sizes "
          "measured.")
      .acts(Acts::input);
}

std::vector<FitParameter> InputNonlinearity::parameters(const Situation& s) const {
  const double peak = size_or_one(s.input_peak);
  const std::string& unit = s.input_unit;
  return {real("input_nonlinearity_square", per("1", unit), 0.1 / peak).says("second power of the input"),
          real("input_nonlinearity_cube", per("1", unit, 2), 0.1 / (peak * peak)).says("third power of the input")};
}

std::vector<std::vector<double>> InputNonlinearity::starts(const Situation&) const { return {{0.0, 0.0}}; }

std::string InputNonlinearity::sentence(std::span<const double> value, std::span<const double>, const Situation& s) const {
  const double x = s.input_peak;
  return "curved characteristic of the actuator: at " + digits(x, 3) + " " + s.input_unit + " off by " +
         digits(100.0 * x * value[0], 2) + " % in the square and " + digits(100.0 * x * x * value[1], 2) + " % in the cube";
}

double InputNonlinearity::map(const double* p, double x, double, double*) const { return x * (1.0 + x * (p[0] + x * p[1])); }

}  // namespace bodeflow::residual
