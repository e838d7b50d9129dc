#pragma once

#include <atomic>

namespace bodeflow::tools {

/// A flag that Ctrl-C or SIGTERM sets, so that a run ends with what it has; a second Ctrl-C ends the process at once.
const std::atomic<bool>& stop_on_interrupt();

}  // namespace bodeflow::tools
