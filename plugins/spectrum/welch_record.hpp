#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "records.hpp"
#include "welch.hpp"

namespace bodeflow::spectrum {

/// What a Welch estimate was made from.
struct WelchOrigin {
  WelchSettings settings;
  WelchForm form = WelchForm::h1;
  Signals inputs, outputs;
  std::vector<double> input_amplitude;  ///< largest |u|, one an input
  std::vector<std::string> warnings;    ///< what the record says of them
};

/// "h1", "h2", "hv".
std::string name_of(WelchForm form);

/// Linewidth of the estimate in Hz: the equivalent noise bandwidth of the window.
double resolution_hz(const WelchSettings& settings);

/// What spoils the estimate, each with what to do, behind the warnings that stand already: few averages, low coherence,
/// resonances narrower than the resolution shows.
std::vector<std::string> welch_warnings(const WelchEstimate& estimate, const WelchOrigin& from);

/// The record `frequency_response` of the estimate, with coherence and densities.
RecordBuilder welch_record(const WelchEstimate& estimate, const WelchOrigin& from);

}  // namespace bodeflow::spectrum
