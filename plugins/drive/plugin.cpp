#include <bodeflow/block.hpp>

#include "inverter_block.hpp"

using namespace bodeflow::drive;

BODEFLOW_PLUGIN("drive", "0.1.0", Inverter)
