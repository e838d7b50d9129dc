#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "desired_response.hpp"

namespace bodeflow::adaptive_control {

/// A relay in place of a controller.
struct RelaySettings {
  double amplitude = 1.0;         ///< of u around `offset`
  double offset = 0.0;            ///< of u
  double hysteresis = 0.0;        ///< of y: about three times the noise
  int settling_cycles = 3;        ///< until the oscillation is taken as periodic
  int cycles = 4;                 ///< that are measured
  double largest_output = 1e300;  ///< |y - setpoint| beyond it ends the experiment
};

/// What a relay experiment tells.
struct RelayResult {
  double omega = 0.0;             ///< of the oscillation [rad/s]: near where the plant has a phase of -180 degrees
  std::complex<double> response;  ///< G there, by the discrete Fourier transform over whole cycles
  double describing_gain = 0.0;   ///< pi a / (4 d) with the peak value a: off by some per cent
  double output_amplitude = 0.0;  ///< a
  int zero_samples = 0;           ///< samples of the first response that stay below 2 % of a
  int delay = 0;                  ///< d for the estimators: as many, one less where the first response is beyond 20 % at once
};

/// Relay feedback: u = offset + amplitude while y is below the set point, offset - amplitude above it. The oscillation's
/// frequency is that of a phase of about -180 degrees; period over whole cycles, G by the Fourier sums of u and y there (Astrom &
/// Hagglund 1984 with the DFT in place of the describing function, which is off by 5 to 11 % on the thesis' examples).
class RelayExperiment {
 public:
  /// Errors: an amplitude not above 0, a negative hysteresis, fewer than one cycle.
  static Expected<RelayExperiment> make(const RelaySettings& settings);

  /// u(k) for y(k) and its set point; offset once the experiment is over.
  double step(double y, double setpoint = 0.0);
  bool finished() const { return finished_; }
  /// True where y left its bounds: the experiment ended without a result.
  bool aborted() const { return aborted_; }
  /// Error: not enough cycles, no response at the oscillation's frequency.
  Expected<RelayResult> result(double sample_time) const;

 private:
  explicit RelayExperiment(const RelaySettings& settings) : s_(settings) {}

  RelaySettings s_;
  bool up_ = true, finished_ = false, aborted_ = false;
  std::vector<double> u_, y_;
  std::vector<std::size_t> rises_;  ///< samples at which u went up
};

}  // namespace bodeflow::adaptive_control
