#pragma once

#include <bodeflow/numerics/error.hpp>
#include <vector>

#include "link.hpp"

namespace bodeflow::drive::modbus {

/// The samples of the drive's trace buffer, channel by channel, in the units of the map. Errors: another device than that of the
/// map, a buffer that is not full yet, values that are not finite, those of Link.
numerics::Expected<std::vector<std::vector<double>>> import_trace(Link& link, const RegisterMap& map);

}  // namespace bodeflow::drive::modbus
