#pragma once

#include "report/page.hpp"
#include "report/run_data.hpp"

namespace bodeflow::tools::report {

/// How the phases kept to outside time, on each host: histograms of lateness, overruns, what the system did not permit. Nothing
/// where all clocks were simulated.
void add_pacing(Page& page, const RunData& run);

}  // namespace bodeflow::tools::report
