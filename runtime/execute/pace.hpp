#pragma once

#include "execute/run.hpp"

namespace bodeflow::execute {

/// Sleeps until `time_s` after the run's start on the steady clock; a time that is over already counts as an overrun. False: the
/// run is stopping.
bool wait_until(Run& run, Lane& lane, double time_s);

}  // namespace bodeflow::execute
