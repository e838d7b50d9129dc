#include <bodeflow/block.hpp>

#include "amplitude_block.hpp"
#include "reveal_block.hpp"
#include "trace_block.hpp"

using namespace bodeflow::residual;

BODEFLOW_PLUGIN("residual", "0.1.0", TraceBlock, AmplitudeBlock, Reveal)
