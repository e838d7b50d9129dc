#include "drag.hpp"
#include "low_pass_block.hpp"

// The plugin's name and version, and its blocks and effects.
BODEFLOW_PLUGIN("@NAME@", "0.1.0", LowPassBlock, Drag)
