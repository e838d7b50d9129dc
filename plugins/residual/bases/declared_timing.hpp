#pragma once

#include <bodeflow/base_model.hpp>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// Describes the parameters `hold` and `delay` of a base model whose input is a signal.
void describe_timing(Describe& d, Hold usual);

/// What they say.
Timing read_timing(const Parameters& p);

/// The same in words, for BaseModel::conventions.
std::vector<std::string> timing_words(const Timing& timing);

/// A number with up to 6 digits: "0.0123".
std::string short_text(double value);

}  // namespace bodeflow::residual
