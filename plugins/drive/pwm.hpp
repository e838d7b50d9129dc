#pragma once

#include <array>

#include "clarke.hpp"

namespace bodeflow::drive {

/// The upper switch of a leg conducts from `on` to `off`, in seconds from the start of the PWM period.
struct Pulse {
  double on = 0.0;
  double off = 0.0;
};

/// How a two-level three-phase inverter is switched.
struct Modulation {
  double period_s = 1e-4;
  double dc_link_v = 540.0;
  double dead_time_s = 0.0;
  double compensation_time_s = 0.0;  ///< added to each pulse by the sign of its leg's current (Jeong and Park 1991); 0: none
  bool min_max = false;              ///< zero sequence -(max + min) / 2, which makes the linear range 15 % longer
};

/// One PWM period of the three legs.
struct Switching {
  std::array<Pulse, 3> legs;
  AlphaBeta mean_voltage;  ///< at the terminals, per phase of a star
  bool limited = false;    ///< over-modulation: a leg could not give its share of the reference
};

/// The switching of a period in which the inverter is to give `reference` on average. Symmetric (centre-aligned) PWM: a leg with
/// the duty d is up from (1 - d) T / 2 to (1 + d) T / 2.
///
/// Dead time: after one switch of a leg opens, the other closes `dead_time_s` later, and meanwhile a diode carries the current.
/// A leg whose current flows to the motor stays down, so its rising edge is late; a leg whose current flows back stays up, so
/// its falling edge is late. The sign is that at the start of the period, `current` [A]; without current neither edge is late.
/// `measured` is the current that the compensation knows. Duties are limited such that each leg switches twice a period, with
/// a pulse and a gap of at least two dead times; without dead time the whole range from 0 to 1 is used.
///
/// Wrong when a current changes its sign within a period, and around zero current, where a leg floats during the dead time.
/// Reference: S.-G. Jeong, M.-H. Park, The analysis and compensation of dead-time effects in PWM inverters, IEEE Trans. Ind.
/// Electron. 38(2), 1991, 108-114, doi:10.1109/41.88903.
Switching switching(const Modulation& modulation, AlphaBeta reference, AlphaBeta current, AlphaBeta measured);

/// The largest length of a reference that is given whole in any direction [V].
double linear_range(const Modulation& modulation);

}  // namespace bodeflow::drive
