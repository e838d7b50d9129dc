#include "notch_section.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::filters {

using std::numbers::pi;

numerics::Expected<numerics::Biquad> notch_section(double w_h, double width_h) {
  if (!(w_h > 0 && w_h < pi)) return numerics::refused("a notch must lie between 0 and pi rad (the Nyquist frequency)");
  if (!(width_h > 0 && width_h < pi))
    return numerics::refused("a notch must be wider than 0 and narrower than pi rad (the Nyquist frequency)");
  const double gain = 1 / (1 + std::tan(0.5 * width_h)), turn = -2 * std::cos(w_h);
  return numerics::Biquad{gain, gain * turn, gain, gain * turn, 2 * gain - 1};
}

}  // namespace bodeflow::filters
