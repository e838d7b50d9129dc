#pragma once

#include <bodeflow/numerics/random.hpp>
#include <cstdint>
#include <span>

namespace bodeflow::drive {

/// What a sensor adds to what it measures, in the unit of its stream.
struct SensorErrors {
  double gain = 1.0;
  double offset = 0.0;
  double noise_std = 0.0;      ///< white, normal
  double hum_amplitude = 0.0;  ///< peak
  double hum_frequency_hz = 50.0;
  double hum_phase_rad = 0.0;
  double wobble = 0.0;  ///< relative amplitude of the gain, which goes up and down
  double wobble_frequency_hz = 0.7;
};

/// y[n] becomes g[n] y[n] + offset + hum_amplitude sin(2 pi hum_frequency n / rate + hum_phase) + noise, g[n] = gain (1 +
/// wobble sin(2 pi wobble_frequency n / rate)); `first` is the n of y[0]. One normal deviate a sample is taken from `random`,
/// none where noise_std is 0.
void add_errors(const SensorErrors& errors, double rate_hz, std::uint64_t first, numerics::Random& random, std::span<double> y);

}  // namespace bodeflow::drive
