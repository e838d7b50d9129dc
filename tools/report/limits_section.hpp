#pragma once

#include "report/page.hpp"
#include "report/run_data.hpp"

namespace bodeflow::tools::report {

/// The limits of the phases: what is allowed, what came, how often it was left. Nothing where there are none.
void add_limits(Page& page, const RunData& run);

}  // namespace bodeflow::tools::report
