#pragma once

#include <string>

#include "expected.hpp"
#include "records/recording.hpp"

namespace bodeflow::residual {

/// What an experiment may do and should reach.
struct AmplitudeWish {
  double signal_to_noise_db = 30.0;  ///< wanted, of the output: root mean square of the signal over that of the noise
  double largest_input = 0.0;        ///< in the unit of the input
  double largest_output = 0.0;       ///< in the unit of the output
  double margin = 0.8;               ///< part of the limits that is used
};

/// The amplitude for the next experiment, and what it follows from.
struct AmplitudeChoice {
  double amplitude = 0.0;
  double factor = 1.0;     ///< over the pilot
  std::string limited_by;  ///< signal_to_noise, largest_input or largest_output
  double noise_std = 0.0;
  double output_rms = 0.0;                     ///< of the pilot's signal without noise
  double input_peak = 0.0, output_peak = 0.0;  ///< of the pilot
  double signal_to_noise_db = 0.0;             ///< of the pilot
};

/// The amplitude at which an experiment like the pilot has the wanted signal-to-noise ratio, or as much as the limits allow.
///
/// Method: noise from between the lines of the pilot's spectrum; everything scales with the amplitude. That is wrong where the
/// plant is not linear: after a dead zone (dead time) or in saturation the output grows faster than the amplitude, by the margin
/// at most where the pilot's amplitude is well above the dead zone. Errors: those of experiment_of; a pilot without signal;
/// limits that are not above 0.
Expected<AmplitudeChoice> choose_amplitude(const records::Recording& pilot, double pilot_amplitude, const AmplitudeWish& wish);

}  // namespace bodeflow::residual
