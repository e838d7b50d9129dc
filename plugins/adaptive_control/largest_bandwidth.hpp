#pragma once

#include <optional>

#include "closed_loop.hpp"
#include "designer.hpp"

namespace bodeflow::adaptive_control {

/// How much faster or slower the demands may be made.
struct BandwidthLimit {
  double factor = 0.0;     ///< on all poles of A_m and A_o; 0 where no demand that was tried is good
  double bandwidth = 0.0;  ///< of that G_m [rad/s]: |G_m| = 1 / sqrt 2
};

/// The fastest demands, as a factor on those given, that can be met: with the plant known, those whose controller and closed loop
/// are stable; from points alone, those that `judge` accepts. Method: from the demands as given upwards in steps of 1 % as far as
/// all is well (or downwards to the first that is), then bisection to 1e-6 (section 3.4 of Kallen 1992: there the limit is 0.855
/// rad/s).
Expected<BandwidthLimit> largest_bandwidth(const RstStructure& structure, const DesiredResponse& desired,
                                           const std::vector<std::complex<double>>& response,
                                           const std::optional<SampledPlant>& plant = {}, const AcceptanceLimits& limits = {});

/// The frequency [rad/s] at which |A_m(0) / A_m(i w)| falls below 1 / sqrt 2.
double bandwidth_of(const Eigen::VectorXd& a_m);

}  // namespace bodeflow::adaptive_control
