#pragma once

#include <nlohmann/json.hpp>

namespace bodeflow::tools {

// As in model_summary.hpp: what a screen shows of a record. False: the record lacks what its type promises, nothing was printed.

/// The finding in plain words, the error before and after beside the noise, parameters, what is left by class, every candidate.
bool print_trace(const nlohmann::ordered_json& record);
/// The verdict beside the truth, and the parameters beside the true ones.
bool print_reveal(const nlohmann::ordered_json& record);
/// A chosen amplitude with what it follows from.
bool print_amplitude(const nlohmann::ordered_json& record);

}  // namespace bodeflow::tools
