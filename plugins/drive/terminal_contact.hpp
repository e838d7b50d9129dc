#pragma once

#include <bodeflow/numerics/random.hpp>

#include "clarke.hpp"

namespace bodeflow::drive {

/// What a bad terminal of phase a does. 0 switches an effect off.
struct ContactFaults {
  double loose_ohm = 0.0;       ///< comes and goes, each state lasting kStateLasts_s in the mean
  double rectifying_ohm = 0.0;  ///< the drop is rectifying_ohm |i|: a resistance for current to the motor, its negative back
};

inline constexpr double kStateLasts_s = 0.4;

/// The voltage that the terminal of phase a takes from the motor, one value a PWM period, from the current at its start.
class TerminalContact {
 public:
  TerminalContact(ContactFaults faults, double period_s, std::uint64_t seed)
      : faults_(faults), change_(period_s / kStateLasts_s), random_(numerics::Random::stream(seed, 0)) {}

  /// One period on; an exponential time in each state for periods far shorter than kStateLasts_s.
  AlphaBeta drop(double phase_current) {
    if (faults_.loose_ohm != 0.0 && random_.uniform() < change_) loose_ = !loose_;
    const double volts = (loose_ ? faults_.loose_ohm * phase_current : 0.0) +
                         faults_.rectifying_ohm * (phase_current < 0 ? -1 : 1) * phase_current;
    return clarke(volts, 0.0, 0.0);
  }

 private:
  ContactFaults faults_;
  double change_;  // probability in a period
  numerics::Random random_;
  bool loose_ = false;
};

}  // namespace bodeflow::drive
