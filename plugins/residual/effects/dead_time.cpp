#include "effects/dead_time.hpp"

#include "effects/shapes.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void DeadTime::describe(DescribeEffect& effect) {
  effect.id("residual.dead_time")
      .summary("The inverter loses voltage against the current, because both switches of a leg are off for a while")
      .doc(
          "V s(i / (w + g V)) is lost, s the identity between -1 and 1 and the sign beyond, g V the current that V itself moves "
          "in a step. Averaged over the PWM period. Wrong where the current changes its sign several times within a period.")
      .reference(
          "S.-G. Jeong, M.-H. Park, The analysis and compensation of dead-time effects in PWM inverters, IEEE Trans. Industrial "
          "Electronics 38 (1991) 108")
      .acts(Acts::law, {"inverter"})
      .steps_per_sample(4)
      .rough();
}

std::vector<FitParameter> DeadTime::parameters(const Situation& s) const {
  const Place& place = s.place;
  return {positive("dead_time_voltage", place.reaction_unit).says("lost against the current"),
          positive("dead_time_width", place.flow_unit).says("current within which the loss changes its sign: the ripple")};
}

std::vector<std::vector<double>> DeadTime::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double share : {0.05, 0.2, 0.5})
    starts.push_back({share * size_or_one(s.place.effort), 0.01 * size_or_one(s.place.flow)});
  return starts;
}

std::string DeadTime::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "dead time of the inverter, " + quantity(value[0], std[0], s.place.reaction_unit) + " lost against the current";
}

Reaction DeadTime::react(const double* p, const Signals& s, const double*, double*) const {
  const Shape sign = spread_sign(s.flow, p[1] + s.gain * p[0]);
  return {p[0] * sign.value, p[0] * sign.slope, 0.0};
}

}  // namespace bodeflow::residual
