#pragma once

#include <cstdint>
#include <vector>

#include "records/recording.hpp"

/// A motor at standstill behind an ideal drive, simulated with another set of equations than the tracer's: flux linkages of
/// stator and rotor as states, the magnetising current by iteration, small steps of Heun's method.
namespace bodeflow::residual::bench {

struct SimpleBench {
  double rs = 6.6, rr = 5.5, ls = 0.475, lr = 0.475, lm = 0.454;
  double sample_time_s = 1e-3;
  double computation_delay_s = 100e-6;
  double delay_s = 0.0;             ///< hidden; with the computation delay a multiple of 50 us
  double dead_time_voltage = 0.0;   ///< hidden; lost in the direction of the current
  double saturation_current = 0.0;  ///< hidden; 0: none. psi = Lm (0.25 i + 0.75 isat tanh(i / isat))
  double noise_std = 0.1;
};

/// About 50 odd lines, nearly equal on a logarithmic scale, up to line 819.
std::vector<std::int64_t> test_lines();

/// A recording of `periods` steady periods of 4096 samples after one that is skipped: multisine with random phases.
records::Recording record(const SimpleBench& bench, double amplitude, std::uint64_t seed, std::int64_t periods = 6);

}  // namespace bodeflow::residual::bench
