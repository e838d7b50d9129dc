#include "averaging_dft_block.hpp"

BODEFLOW_PLUGIN("spectrum", "0.1.0", bodeflow::spectrum::AveragingDftBlock)
