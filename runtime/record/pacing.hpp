#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "execute/execute.hpp"

namespace bodeflow::record {

/// How a phase kept time: overruns, skipped chunks, and where the engine paced it the lateness of its chunks (seconds; `bins`
/// counts chunks by lateness: below 1 us, then by octaves up to 1.05 s, then the rest). Null where nothing of it is there.
nlohmann::ordered_json pacing_json(const execute::Outcome& outcome);

/// The same in a sentence for people; "" where nothing is there.
std::string pacing_text(const execute::Outcome& outcome);

}  // namespace bodeflow::record
