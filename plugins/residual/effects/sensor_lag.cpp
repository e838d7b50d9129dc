#include "effects/sensor_lag.hpp"

#include <limits>

#include "effects/response_words.hpp"

namespace bodeflow::residual {

void SensorLag::describe(DescribeEffect& effect) {
  effect.id("residual.sensor_lag")
      .summary("A sensor or filter behind the plant is slow.")
      .doc(
          "1 / (1 + s T), T >= 0. Far below 1 / T it can't be told from a delay of T: only the magnitude, which falls by (w T)^2 "
          "/ 2, "
          "tells.")
      .acts(Acts::series);
}

std::vector<FitParameter> SensorLag::parameters(const Situation& s) const {
  return {real("sensor_lag", "s", 0.1 / lines::highest_omega(s))
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("time constant of the sensor or filter")};
}

std::vector<std::vector<double>> SensorLag::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts = {{0.0}, {0.5 / lines::highest_omega(s)}};
  if (const double found = lines::phase_slope_s(s); found > 0.0) starts.push_back({found});
  return starts;
}

std::string SensorLag::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "lag of the sensor, time constant " + lines::time_words(value[0], std[0]);
}

std::complex<double> SensorLag::transfer(const double* p, std::complex<double> s) const { return 1.0 / (1.0 + s * p[0]); }

}  // namespace bodeflow::residual
