#include "averaging_dft_block.hpp"

BODEFLOW_PLUGIN("spectrum", "1.0.0", bodeflow::spectrum::AveragingDftBlock)
