#pragma once

#include "generate/oscillator.hpp"

namespace battery {

/// Position at every substep, settling included, of an oscillator that rubs with a constant force: it slides one way or the
/// other, or sticks while the other forces are smaller. The instants at which it stops and breaks away are located.
Series stick_slip(const Oscillator& o, double friction, const Drive& d);

}  // namespace battery
