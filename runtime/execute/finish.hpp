#pragma once

#include "execute/run.hpp"

namespace bodeflow::execute {

/// The end of a run whose streams have all ended, on the finisher's lane: asynchronous blocks finish what they were given,
/// blocks without streams take what is left, then in plan.order each block takes what the finish of earlier ones sent and
/// finishes itself.
void finish_run(Run& run);

}  // namespace bodeflow::execute
