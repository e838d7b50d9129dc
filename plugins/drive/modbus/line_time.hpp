#pragma once

#include <vector>

#include "register_map.hpp"

namespace bodeflow::drive::modbus {

/// The time that one cycle of drive.modbus takes on a serial line at least [s]: the characters of its questions and answers with
/// 11 bits each and the silences of 3.5 characters around them; the drive's own time to answer comes on top.
/// Reference: MODBUS over Serial Line V1.02, 2006, section 2.5.
double line_time(const RegisterMap& map, const std::vector<std::size_t>& set_points, const std::vector<std::size_t>& read,
                 int baud);

}  // namespace bodeflow::drive::modbus
