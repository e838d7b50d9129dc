#include "effects/play.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void Play::describe(DescribeEffect& effect) {
  effect.id("residual.play")
      .summary("There is clearance between the plant and its sensor: the reading rests while the movement turns around")
      .doc(
          "The play operator (Krasnoselskii): the reading follows y at a distance of at most r. It delays by an angle that does "
          "not depend on the frequency and falls with the amplitude. Wrong where the reading side is heavy and moves on by "
          "itself.")
      .reference("M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, 1996, section 2.1")
      .acts(Acts::output)
      .memory(1)
      .rough();
}

std::vector<FitParameter> Play::parameters(const Situation& s) const {
  return {positive("play", s.output_unit).says("distance on either side that is passed without contact")};
}

std::vector<std::vector<double>> Play::starts(const Situation& s) const {
  return {{0.02 * size_or_one(s.output_rms)}, {0.2 * size_or_one(s.output_rms)}};
}

std::string Play::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "play in front of the sensor, +-" + quantity(value[0], std[0], s.output_unit);
}

double Play::map(const double* p, double x, double, double* memory) const { return memory[0] = with_play(memory[0], x, p[0]); }

}  // namespace bodeflow::residual
