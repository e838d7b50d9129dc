#pragma once

#include "desired_response.hpp"
#include "rst.hpp"

namespace bodeflow::adaptive_control {

/// G(z) = b(z) / a(z), a monic, descending powers; whole samples of delay are poles at 0.
struct SampledPlant {
  Eigen::VectorXd b, a;
};

/// A continuous-time plant behind a zero-order hold, as polynomials. Errors: those of numerics::zero_order_hold.
Expected<SampledPlant> sampled_plant(const numerics::TransferFunction& plant, double delay_s, double sample_time);

/// What a known plant and a fixed controller do together.
struct LoopQuality {
  Eigen::VectorXcd poles;        ///< roots of A R + B S
  double largest_pole = 0.0;     ///< their largest magnitude; stable below 1
  double sensitivity = 0.0;      ///< M_s: the largest 1 / |1 + L| up to the Nyquist frequency
  double gain_margin = 0.0;      ///< least 1 / |L| above 1 where L is real and negative; 0 where there is none
  double controller_pole = 0.0;  ///< real part of the leftmost root of R: near -1 the control signal rings
};

/// Method: roots for the poles; M_s and the gain margin on a grid of 4000 frequencies, the maximum refined by golden section, the
/// crossings by linear interpolation.
Expected<LoopQuality> loop_quality(const SampledPlant& plant, const Rst& controller);

}  // namespace bodeflow::adaptive_control
