#include "sensor_errors.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::drive {

namespace {

/// sin(2 pi f n / rate + phase) without loss for large n.
double sine(double frequency_hz, std::uint64_t n, double rate_hz, double phase_rad) {
  const double cycles = frequency_hz * (static_cast<double>(n) / rate_hz);
  return std::sin(2 * std::numbers::pi * (cycles - std::floor(cycles)) + phase_rad);
}

}  // namespace

void add_errors(const SensorErrors& errors, double rate_hz, std::uint64_t first, numerics::Random& random, std::span<double> y) {
  if (errors.wobble != 0) {
    for (std::size_t n = 0; n < y.size(); ++n)
      y[n] *= 1 + errors.wobble * sine(errors.wobble_frequency_hz, first + n, rate_hz, 0);
  }
  for (double& value : y) value = errors.gain * value + errors.offset;
  if (errors.hum_amplitude != 0) {
    for (std::size_t n = 0; n < y.size(); ++n)
      y[n] += errors.hum_amplitude * sine(errors.hum_frequency_hz, first + n, rate_hz, errors.hum_phase_rad);
  }
  if (errors.noise_std == 0) return;
  for (double& value : y) value += errors.noise_std * random.normal();
}

}  // namespace bodeflow::drive
