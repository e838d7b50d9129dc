#include <bodeflow/block.hpp>

#include "linear_block.hpp"

using namespace bodeflow::plants;

BODEFLOW_PLUGIN("plants", "0.1.0", Linear)
