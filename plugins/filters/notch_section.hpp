#pragma once

#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/second_order_sections.hpp>

namespace bodeflow::filters {

/// The second-order section with zeros exactly at exp(+-j w_h), gain 1 at zero and at the Nyquist frequency, and -3 dB over a
/// band of `width_h` around w_h, both in rad per sample. Method: the bilinear transformation of (s^2 + w^2) / (s^2 + B s + w^2),
/// pre-warped. Errors: not 0 < w_h < pi, not 0 < width_h < pi.
numerics::Expected<numerics::Biquad> notch_section(double w_h, double width_h);

}  // namespace bodeflow::filters
