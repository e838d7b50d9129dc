#include "sensor_errors.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::drive {

void add_errors(const SensorErrors& errors, double rate_hz, std::uint64_t first, numerics::Random& random, std::span<double> y) {
  for (double& value : y) value = errors.gain * value + errors.offset;
  if (errors.hum_amplitude != 0) {
    for (std::size_t n = 0; n < y.size(); ++n) {
      const double cycles = errors.hum_frequency_hz * (static_cast<double>(first + n) / rate_hz);
      y[n] += errors.hum_amplitude * std::sin(2 * std::numbers::pi * (cycles - std::floor(cycles)) + errors.hum_phase_rad);
    }
  }
  if (errors.noise_std == 0) return;
  for (double& value : y) value += errors.noise_std * random.normal();
}

}  // namespace bodeflow::drive
