#include "effects/output_nonlinearity.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void OutputNonlinearity::describe(DescribeEffect& effect) {
  effect.id("residual.output_nonlinearity")
      .summary("The characteristic of the sensor is curved")
      .doc(
          "y + a y^2 + b y^3. A gain error is no part of it: that merges with the base model. Wrong far beyond the sizes "
          "measured.")
      .acts(Acts::output);
}

std::vector<FitParameter> OutputNonlinearity::parameters(const Situation& s) const {
  const double peak = size_or_one(s.output_peak);
  const std::string& unit = s.output_unit;
  return {real("output_nonlinearity_square", per("1", unit), 0.1 / peak).says("second power of the output"),
          real("output_nonlinearity_cube", per("1", unit, 2), 0.1 / (peak * peak)).says("third power of the output")};
}

std::vector<std::vector<double>> OutputNonlinearity::starts(const Situation&) const { return {{0.0, 0.0}}; }

std::string OutputNonlinearity::sentence(std::span<const double> value, std::span<const double>, const Situation& s) const {
  const double x = s.output_peak;
  return "curved characteristic of the sensor: at " + digits(x, 3) + " " + s.output_unit + " off by " +
         digits(100.0 * x * value[0], 2) + " % in the square and " + digits(100.0 * x * x * value[1], 2) + " % in the cube";
}

double OutputNonlinearity::map(const double* p, double x, double, double*) const { return x * (1.0 + x * (p[0] + x * p[1])); }

}  // namespace bodeflow::residual
