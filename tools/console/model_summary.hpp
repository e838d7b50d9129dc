#pragma once

#include <nlohmann/json.hpp>

namespace bodeflow::tools {

// One function a record type: prints what a screen shows of it. False: the record lacks what its type promises, nothing was
// printed.

/// Parameters with deviations, poles in Hz with damping, cost beside the expected one.
bool print_model(const nlohmann::ordered_json& record);
/// What follows from a model: parameters with deviations, and the assumption that they rest on.
bool print_derived_parameters(const nlohmann::ordered_json& record);
/// The fits of each model, then parameters and poles side by side.
bool print_comparison(const nlohmann::ordered_json& record);
/// The verdict on a change, bands and resonances.
bool print_change(const nlohmann::ordered_json& record);
/// Mean and spread beside truth and published figures.
bool print_monte_carlo(const nlohmann::ordered_json& record);

}  // namespace bodeflow::tools
