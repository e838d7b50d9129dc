#include "effects/clipping.hpp"

#include <algorithm>

#include "effects/words.hpp"

namespace bodeflow::residual {

void Clipping::describe(DescribeEffect& effect) {
  effect.id("residual.clipping")
      .summary("A sensor clips: its reading ends at a limit")
      .doc("The output stays between -c and c. Wrong where the limits differ, or are soft.")
      .acts(Acts::output)
      .rough();
}

std::vector<FitParameter> Clipping::parameters(const Situation& s) const {
  return {positive("clipping_limit", s.output_unit).says("largest magnitude of the output")};
}

std::vector<std::vector<double>> Clipping::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double share : {0.95, 0.7}) starts.push_back({share * size_or_one(s.output_peak)});
  return starts;
}

std::string Clipping::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "sensor that clips at " + quantity(value[0], std[0], s.output_unit);
}

double Clipping::map(const double* p, double x, double, double*) const { return std::clamp(x, -p[0], p[0]); }

}  // namespace bodeflow::residual
