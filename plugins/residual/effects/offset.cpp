#include "effects/offset.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void Offset::describe(DescribeEffect& effect) {
  effect.id("residual.offset")
      .summary("The sensor adds a constant to what it measures")
      .doc("y + b. On a nonlinear plant it is seen beside the lines too, and a spring that is stiffer to one side looks alike.")
      .acts(Acts::output)
      .constant();
}

std::vector<FitParameter> Offset::parameters(const Situation& s) const {
  return {real("offset", s.output_unit, size_or_one(s.output_rms)).says("added to the output")};
}

std::vector<std::vector<double>> Offset::starts(const Situation& s) const { return {{s.residual_mean}}; }

std::string Offset::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "offset of the sensor, " + quantity(value[0], std[0], s.output_unit);
}

double Offset::map(const double* p, double x, double, double*) const { return x + p[0]; }

}  // namespace bodeflow::residual
