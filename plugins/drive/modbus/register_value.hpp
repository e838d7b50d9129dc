#pragma once

#include <array>
#include <bodeflow/numerics/error.hpp>
#include <cstdint>

#include "register_map.hpp"

namespace bodeflow::drive::modbus {

/// The value that one or two words stand for, in the register's unit. A float32 may be NaN or infinite: the caller looks.
double decoded(const Register& r, const std::uint16_t* words);

/// The words of a value, rounded to the nearest number that the register can hold. Errors: not finite, beyond the encoding.
numerics::Expected<std::array<std::uint16_t, 2>> encoded(const Register& r, double value);

}  // namespace bodeflow::drive::modbus
