#pragma once

#include "link.hpp"

namespace bodeflow::drive::modbus {

/// The value in a register, in its unit. Errors: those of Link.
numerics::Expected<double> read_value(Link& link, const Register& r);

/// Whether the device is the one that the map is of. Errors: a register that reads something else, those of Link.
numerics::Expected<void> check_identity(Link& link, const RegisterMap& map);

}  // namespace bodeflow::drive::modbus
