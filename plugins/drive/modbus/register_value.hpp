#pragma once

#include <array>
#include <bodeflow/numerics/error.hpp>
#include <cstdint>

#include "register_map.hpp"

namespace bodeflow::drive::modbus {

/// "12.5 rpm"; the number alone where there is no dimension.
std::string quantity(double value, const Register& r);

/// The value that one or two words stand for, in the register's unit. A float32 may be NaN or infinite: the caller looks.
double decoded(const Register& r, const std::uint16_t* words);

/// The words of a value, rounded to the nearest number that the register can hold. Errors: not finite, beyond the encoding.
numerics::Expected<std::array<std::uint16_t, 2>> encoded(const Register& r, double value);

/// A time as a number in the unit of that register: s, ms or us.
double watchdog_value(const Register& r, double seconds);

}  // namespace bodeflow::drive::modbus
