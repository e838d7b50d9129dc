#pragma once

#include <bodeflow/block.hpp>

#include "link.hpp"

namespace bodeflow::drive::modbus {

/// Describes the parameters that say where a drive is, and `map`.
void describe_connection(Describe& d);

/// The endpoint that they give. Throws Failure.
Endpoint read_connection(const Parameters& p);

}  // namespace bodeflow::drive::modbus
