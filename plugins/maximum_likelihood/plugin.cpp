#include "model_block.hpp"

BODEFLOW_PLUGIN("maximum_likelihood", "0.1.0", bodeflow::maximum_likelihood::ModelBlock)
