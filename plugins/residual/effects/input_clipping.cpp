#include "effects/input_clipping.hpp"

#include <algorithm>

#include "effects/words.hpp"

namespace bodeflow::residual {

void InputClipping::describe(DescribeEffect& effect) {
  effect.id("residual.input_clipping")
      .summary("An actuator clips: it gives no more than its limit")
      .doc("The input stays between -c and c. Wrong where the limits differ, or are soft.")
      .acts(Acts::input)
      .rough();
}

std::vector<FitParameter> InputClipping::parameters(const Situation& s) const {
  return {positive("input_clipping_limit", s.input_unit).says("largest magnitude of the input")};
}

std::vector<std::vector<double>> InputClipping::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double share : {0.95, 0.7}) starts.push_back({share * size_or_one(s.input_peak)});
  return starts;
}

std::string InputClipping::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "actuator that clips at " + quantity(value[0], std[0], s.input_unit);
}

double InputClipping::map(const double* p, double x, double, double*) const { return std::clamp(x, -p[0], p[0]); }

}  // namespace bodeflow::residual
