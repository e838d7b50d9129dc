#pragma once

#include <nlohmann/json.hpp>

#include "observe/watch.hpp"

namespace bodeflow::tools::live {

/// What the page shows of a moment, but for messages and the run's own end: phase, progress, blocks, streams, records,
/// parameters, changes, lateness.
nlohmann::ordered_json to_json(const observe::Look& look);

/// "gain.gain = 2 from sample 1200 on (1.2 s)", "... refused: ...", "... the phase ended before".
std::string change_text(const observe::Change& change);

}  // namespace bodeflow::tools::live
