#include <bodeflow/block.hpp>

#include "chirp_block.hpp"
#include "coloured_noise_block.hpp"
#include "multisine_block.hpp"
#include "nco_block.hpp"
#include "noise_block.hpp"
#include "prbs_block.hpp"
#include "pulses_block.hpp"
#include "ramp_block.hpp"
#include "sine_block.hpp"
#include "square_block.hpp"
#include "step_block.hpp"
#include "stepped_sine_block.hpp"

using namespace bodeflow::generators;

BODEFLOW_PLUGIN("generators", "0.1.0", Sine, Noise, Multisine, SteppedSine, Square, Chirp, Prbs, ColouredNoise, Step, Ramp,
                Pulses, Nco)
