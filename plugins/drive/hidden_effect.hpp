#pragma once

#include <array>
#include <bodeflow/numerics/error.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "motor_parameters.hpp"

namespace bodeflow::drive {

/// An effect that a bench can hide.
struct EffectKind {
  const char* name;
  const char* property;    ///< of the record `bench_properties`, that has its size; "" for none
  const char* unit;        ///< of the size, SI
  double least, greatest;  ///< sizes that are seen in the experiments of this family's graphs
  const char* size_is;
  int likeness;  ///< effects of the same number act alike, so a pair never has both
};

using EffectTable = std::span<const EffectKind>;

/// Of inverter, motor and current sensor; `none` first. Ranges: experiments with 4 V a line below 6 Hz and 8 V a line up to 96
/// Hz.
inline constexpr std::array<EffectKind, 14> kDriveEffects{{
    {"none", "", "", 0, 0, "", 0},
    {"delay", "current_delay", "s", 100e-6, 400e-6, "transport delay of the current sensor", 1},
    {"dead_time", "dead_time", "s", 0.5e-6, 2e-6, "dead time of the inverter", 2},
    {"saturation", "saturation_current", "A", 0.7, 1.3, "current at which the iron saturates", 3},
    {"skin_effect", "bar_height", "m", 16e-3, 30e-3, "height of the rotor bars", 1},
    {"iron_loss", "iron_loss_resistance", "ohm", 40, 90, "resistance of the iron loss beside the magnetising inductance", 1},
    {"resistance_drift", "resistance_drift", "1", 0.12, 0.3, "relative rise of the stator resistance", 4},
    {"sensor_lag", "current_lag", "s", 100e-6, 400e-6, "time constant of the current sensor", 1},
    {"offset", "current_offset", "A", 0.05, 0.5, "offset of the current sensor", 5},
    {"hum", "current_hum", "A", 0.05, 0.5, "peak value of the mains hum in the measured current", 6},
    {"loose_contact", "contact_resistance", "ohm", 0.3, 2, "resistance that comes and goes in the terminal of phase a", 4},
    {"rectifying_contact", "rectifying_resistance", "ohm", 0.3, 2,
     "resistance, positive for current to the motor and negative back, of a corroded terminal of phase a", 5},
    {"gain_wobble", "current_wobble", "1", 0.02, 0.1, "relative amplitude of the current sensor's gain, which goes up and down",
     4},
    {"link_ripple", "link_ripple", "1", 0.02, 0.1, "relative amplitude of the ripple of the DC link", 4},
}};

/// Of an axis: motor, coupling, load; `none` first. Ranges: those that graphs/close_the_loop/virtual_axis.yaml sees.
inline constexpr std::array<EffectKind, 9> kAxisEffects{{
    {"none", "", "", 0, 0, "", 0},
    {"coulomb_friction", "motor_friction", "Nm", 0.01, 0.06, "dry friction in the motor's bearing", 1},
    {"stribeck_friction", "motor_stribeck", "Nm", 0.02, 0.06, "dry friction in the motor's bearing, higher at low speed", 1},
    {"backlash", "backlash", "rad", 1e-3, 6e-3, "play of the coupling, half of the gap", 2},
    {"cubic_stiffness", "progression_angle", "rad", 4e-3, 15e-3, "twist at which the coupling has stiffened by half", 2},
    {"cogging", "cogging", "Nm", 0.01, 0.05, "peak of the torque between magnets and teeth", 3},
    {"turning_inertia", "turning_inertia", "1", 0.1, 0.3, "relative change of the load's inertia over half a turn", 3},
    {"rub", "rub", "Nm", 0.05, 0.2, "dry friction of a contact that the load meets once a turn", 1},
    {"magnet_flutter", "magnet_flutter", "1", 0.05, 0.2, "relative amplitude of the torque constant, which goes up and down", 4},
}};

/// The effect of that name, or nothing.
const EffectKind* find_effect(EffectTable table, const std::string& name);

/// Sizes from `least` to `greatest`, both above 0.
struct SizeRange {
  double least, greatest;
};

struct HiddenEffect {
  const EffectKind* kind;
  double size;
};

/// Shares of the benches that hide nothing, one of `effects`, two of them, or one of `outside`; their sum is 1.
struct Odds {
  double none, one, two, outside;
};

struct Draw {
  EffectTable table;
  std::vector<SizeRange> ranges;     ///< one for each of the table
  std::vector<std::string> effects;  ///< without odds each is as likely as the others, "none" included
  std::vector<std::string> outside;  ///< of which nobody but the bench knows
  std::optional<Odds> odds;
};

/// What is hidden: nothing, one effect or two that do not act alike, each with a size log-uniform within its range. The same seed
/// and draw, the same effects. Errors, by name: no names, unknown ones, a range that is none, odds that are none or that ask for
/// what the lists do not have.
numerics::Expected<std::vector<HiddenEffect>> draw_effects(std::uint64_t seed, const Draw& draw);

/// A motor whose resistances, magnetising inductance lm and leakages ls - lm, lr - lm lie each within +- spread (relative,
/// uniform) of the nominal ones, so that the coupling stays below 1. What is drawn does not depend on the effect. Errors: those
/// of `checked`, lm above ls or lr.
numerics::Expected<MotorParameters> draw_motor(std::uint64_t seed, const MotorParameters& nominal, double spread);

/// The values, each within +- spread (relative, uniform).
std::vector<double> draw_near(std::uint64_t seed, const std::vector<double>& nominal, double spread);

}  // namespace bodeflow::drive
