#include <bodeflow/block.hpp>

#include "modbus_block.hpp"
#include "modbus_trace_block.hpp"

using namespace bodeflow::drive::modbus;

BODEFLOW_PLUGIN("drive_modbus", "0.1.0", ModbusBlock, ModbusTraceBlock)
