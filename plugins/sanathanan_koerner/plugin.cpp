#include "model_block.hpp"
#include "multi_band_block.hpp"
#include "vector_fitting_block.hpp"

BODEFLOW_PLUGIN("sanathanan_koerner", "0.1.0", bodeflow::sanathanan_koerner::ModelBlock,
                bodeflow::sanathanan_koerner::VectorFittingBlock, bodeflow::sanathanan_koerner::MultiBandBlock)
