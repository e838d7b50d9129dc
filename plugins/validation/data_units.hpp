#pragma once

#include "records/model.hpp"
#include "records/signals.hpp"

namespace bodeflow::validation {

/// The model as one from the unit of `input` to that of `output`: numerator and amplitude converted, its parameters left as they
/// are. Units that are not known are taken as right. Error: another dimension, by name.
Expected<records::ModelData> in_units_of(const records::Signals& input, const records::Signals& output, records::ModelData model);

}  // namespace bodeflow::validation
