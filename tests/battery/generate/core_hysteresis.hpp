#pragma once

#include "generate/hidden.hpp"

namespace battery {

/// Hysteresis of the motor's core: elastic-plastic elements over the main flux (L. Prandtl 1928). Its name is that of the law by
/// which a catalogue has hysteresis.
Hidden core_hysteresis(const Motor& motor, const Scale& scale, Random& random);

}  // namespace battery
