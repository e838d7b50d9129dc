#include <bodeflow/block.hpp>

#include "multisine_block.hpp"
#include "noise_block.hpp"
#include "sine_block.hpp"
#include "stepped_sine_block.hpp"

using namespace bodeflow::generators;

BODEFLOW_PLUGIN("generators", "0.1.0", Sine, Noise, Multisine, SteppedSine)
