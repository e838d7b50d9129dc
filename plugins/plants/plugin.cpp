#include <bodeflow/block.hpp>

#include "ladder_block.hpp"
#include "linear_block.hpp"
#include "modes_block.hpp"
#include "response_block.hpp"

using namespace bodeflow::plants;

BODEFLOW_PLUGIN("plants", "0.1.0", LadderBlock, Linear, ModesBlock, ResponseBlock)
