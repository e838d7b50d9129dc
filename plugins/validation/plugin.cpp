#include <bodeflow/block.hpp>

#include "monte_carlo_block.hpp"

using namespace bodeflow::validation;

BODEFLOW_PLUGIN("validation", "0.1.0", MonteCarlo)
