#include "model_block.hpp"

BODEFLOW_PLUGIN("subspace", "0.1.0", bodeflow::subspace::ModelBlock)
