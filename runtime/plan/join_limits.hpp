#pragma once

#include <vector>

#include "plan/limits.hpp"

namespace bodeflow::plan {

/// Looks at the limits of each port together: refuses bounds that no value fulfils, and sets Limit::start.
void join_limits(const graph::Phase& phase, std::vector<Limit>& limits, Problems& problems);

}  // namespace bodeflow::plan
