#include "decorrelated_noise_block.hpp"
#include "model_block.hpp"

BODEFLOW_PLUGIN("koopmans_levin", "0.1.0", bodeflow::koopmans_levin::ModelBlock, bodeflow::koopmans_levin::DecorrelatedNoise)
