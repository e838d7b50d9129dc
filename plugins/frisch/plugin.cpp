#include "known_motor_block.hpp"
#include "motor_block.hpp"
#include "noise_block.hpp"

BODEFLOW_PLUGIN("frisch", "0.1.0", bodeflow::frisch::Motor, bodeflow::frisch::Noise, bodeflow::frisch::KnownMotor)
