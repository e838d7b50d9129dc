#include "effects/gain_step.hpp"

#include "effects/instants.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void GainStep::describe(DescribeEffect& effect) {
  effect.id("residual.gain_step")
      .summary("The gain of the sensor jumps while the record is taken")
      .doc("y (1 + g) from an instant on. In every record at the same time since it began: wrong where it happens once.")
      .acts(Acts::output)
      .memory(2)
      .nonstationary();
}

std::vector<FitParameter> GainStep::parameters(const Situation& s) const {
  return {real("gain_step", "1", 0.05).between(-1.0, 1e3).says("by which share the gain jumps"), instant(s)};
}

std::vector<std::vector<double>> GainStep::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double at : likely_instants(s)) starts.push_back({0.0, at});
  return starts;
}

std::string GainStep::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "gain of the sensor that jumps by " + quantity(100.0 * value[0], 100.0 * std[0], "%") + " " + digits(value[1], 4) +
         " s after the record began";
}

double GainStep::map(const double* p, double x, double time_s, double* memory) const {
  const double sample_s = memory[1] > 0.0 ? time_s - memory[0] : 0.0;
  memory[0] = time_s;
  memory[1] = 1.0;
  return x * (1.0 + p[0] * after(p[1], time_s, sample_s));
}

}  // namespace bodeflow::residual
