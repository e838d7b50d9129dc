#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "execute/execute.hpp"

namespace bodeflow::record {

/// How a phase kept time: the settings of its clock, overruns, skipped chunks, what was not permitted, and where the engine paced
/// it the lateness of its chunks (seconds; `bins` counts chunks by lateness: below 1 us, then by octaves up to 1.05 s, then the
/// rest). Null with the simulated clock.
nlohmann::ordered_json pacing_json(const graph::RunSettings& run, const execute::Outcome& outcome);

/// What such a JSON tells of lateness and overruns, in a sentence for people; "" where nothing is there.
std::string pacing_text(const nlohmann::ordered_json& pacing);

}  // namespace bodeflow::record
