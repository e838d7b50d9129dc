#include <bodeflow/block.hpp>

#include "decimate_block.hpp"
#include "delay_block.hpp"
#include "gain_block.hpp"
#include "hold_block.hpp"
#include "static_nonlinearity_block.hpp"
#include "sum_block.hpp"

using namespace bodeflow::filters;

BODEFLOW_PLUGIN("filters", "0.1.0", Gain, Delay, Hold, Decimate, StaticNonlinearity, Sum)
