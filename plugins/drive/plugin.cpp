#include <bodeflow/block.hpp>

#include "axis_block.hpp"
#include "classical_tests_block.hpp"
#include "command_buffer_block.hpp"
#include "current_sensor_block.hpp"
#include "encoder_block.hpp"
#include "friction_feed_forward_block.hpp"
#include "hidden_axis_effect_block.hpp"
#include "hidden_effect_block.hpp"
#include "induction_motor_block.hpp"
#include "inverter_block.hpp"
#include "power_meter_block.hpp"
#include "property_change_block.hpp"
#include "supply_block.hpp"
#include "voltage_sensor_block.hpp"

using namespace bodeflow::drive;

BODEFLOW_PLUGIN("drive", "0.1.0", CurrentSensor, VoltageSensor, Encoder, HiddenEffectBlock, HiddenAxisEffect, AxisBlock,
                FrictionFeedForward, CommandBuffer, Supply, PropertyChange, PowerMeter, ClassicalTests, Inverter, InductionMotor)
