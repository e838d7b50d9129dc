#include "effects/delay.hpp"

#include <limits>

#include "effects/response_words.hpp"

namespace bodeflow::residual {

void Delay::describe(DescribeEffect& effect) {
  effect.id("residual.delay")
      .summary("The output comes later than the model says.")
      .doc(
          "y(t - d), d >= 0: of a computation, a converter, a line, beyond what the base model declares. The phase falls in "
          "proportion "
          "to the frequency, the magnitude stays.")
      .acts(Acts::delay)
      .equivalent_to({"skin_effect"},
                     "put a resistor in the place of the motor: a delay of the drive stays, a skin effect of the rotor does not");
}

std::vector<FitParameter> Delay::parameters(const Situation& s) const {
  return {real("delay", "s", 0.1 / lines::highest_omega(s))
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("time by which the output is late")};
}

std::vector<std::vector<double>> Delay::starts(const Situation& s) const {
  const double found = lines::phase_slope_s(s);
  std::vector<std::vector<double>> starts = {{0.0}};
  if (found > 0.0) starts.push_back({found});
  return starts;
}

std::string Delay::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "delay of " + lines::time_words(value[0], std[0]) + " that is not declared";
}

double Delay::delay_s(const double* p) const { return p[0]; }

}  // namespace bodeflow::residual
