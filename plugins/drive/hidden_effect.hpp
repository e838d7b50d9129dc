#pragma once

#include <array>
#include <bodeflow/numerics/error.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "motor_parameters.hpp"

namespace bodeflow::drive {

/// An effect that a bench can hide.
struct EffectKind {
  const char* name;
  const char* property;    ///< of the record `bench_properties`, that has its size; "" for none
  const char* unit;        ///< of the size, SI
  double least, greatest;  ///< sizes that an experiment with 4 V a line below 6 Hz and 8 V a line up to 96 Hz sees
  const char* size_is;
};

/// `none` first.
inline constexpr std::array<EffectKind, 10> kEffects{{
    {"none", "", "", 0, 0, ""},
    {"delay", "current_delay", "s", 100e-6, 400e-6, "transport delay of the current sensor"},
    {"dead_time", "dead_time", "s", 0.5e-6, 2e-6, "dead time of the inverter"},
    {"saturation", "saturation_current", "A", 0.7, 1.3, "current at which the iron saturates"},
    {"skin_effect", "bar_height", "m", 16e-3, 30e-3, "height of the rotor bars"},
    {"iron_loss", "iron_loss_resistance", "ohm", 40, 90, "resistance of the iron loss beside the magnetising inductance"},
    {"resistance_drift", "resistance_drift", "1", 0.12, 0.3, "relative rise of the stator resistance"},
    {"sensor_lag", "current_lag", "s", 100e-6, 400e-6, "time constant of the current sensor"},
    {"offset", "current_offset", "A", 0.05, 0.5, "offset of the current sensor"},
    {"hum", "current_hum", "A", 0.05, 0.5, "peak value of the mains hum in the measured current"},
}};

/// The effect of that name, or nothing.
const EffectKind* find_effect(const std::string& name);

/// Sizes from `least` to `greatest`, both above 0.
struct SizeRange {
  double least, greatest;
};

struct HiddenEffect {
  const EffectKind* kind;
  double size;  ///< 0 for none
};

/// One of `names`, each as likely as the others, with a size log-uniform within its range: `ranges` has one for each of kEffects.
/// The same seed, names and ranges, the same effect. Errors, by name: no names, unknown ones, a range that is none.
numerics::Expected<HiddenEffect> draw_effect(std::uint64_t seed, const std::vector<std::string>& names,
                                             const std::array<SizeRange, kEffects.size()>& ranges);

/// A motor whose resistances, magnetising inductance lm and leakages ls - lm, lr - lm lie each within +- spread (relative,
/// uniform) of the nominal ones, so that the coupling stays below 1. What is drawn does not depend on the effect. Errors: those
/// of `checked`, lm above ls or lr.
numerics::Expected<MotorParameters> draw_motor(std::uint64_t seed, const MotorParameters& nominal, double spread);

}  // namespace bodeflow::drive
