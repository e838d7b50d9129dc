#pragma once

#include "generate/motor.hpp"

namespace battery {

/// A leg of an inverter between +link/2 and -link/2, with a symmetric pulse in each of its periods.
struct Switching {
  double link = 325.0;  ///< [V]
  std::size_t periods_per_sample = 10;
  double dead_time = 0.0;  ///< [s] both switches are open at each edge
};

/// Samples of the record's current, solved exactly from switching instant to switching instant. While both switches are open a
/// diode carries the current: towards the motor it keeps the leg down, so the pulse rises late; back, it keeps it up, so the
/// pulse falls late.
Series switched_current(const Motor& motor, const Switching& s, const Drive& d);

}  // namespace battery
