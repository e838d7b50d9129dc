#pragma once

#include <nlohmann/json.hpp>

#include "execute/execute.hpp"

namespace bodeflow::record {

/// The limits of a run of a phase for its manifest: as the plan has them, with the samples that they looked at, violations, the
/// first one, extremes; the one that ended the run is marked. Null where there are none.
nlohmann::ordered_json limits_json(const nlohmann::json& planned, const execute::Outcome& outcome);

/// A first violation, for the events.
nlohmann::json violation_json(const plan::Limit& limit, const execute::Violation& violation);

}  // namespace bodeflow::record
