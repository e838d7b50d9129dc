#pragma once

#include <vector>

#include "desired_response.hpp"
#include "rst.hpp"

namespace bodeflow::adaptive_control {

/// The frequency omega_o at which the loop gain has a phase of -180 degrees, from the desired response and the controller alone
/// (7.2): G_o = G_m / (T / S - G_m), good as far as the closed loop follows G_m.
class CriticalFrequency {
 public:
  /// Errors: those of desired_points.
  static Expected<CriticalFrequency> make(const DesiredResponse& desired, double sample_time);

  /// omega_o [rad/s]; 0 where the phase does not reach -180 degrees below the Nyquist frequency. Allocates nothing.
  double estimate(const Rst& controller) const;

 private:
  std::vector<double> omega_;
  std::vector<std::complex<double>> g_m_, z_;
};

}  // namespace bodeflow::adaptive_control
