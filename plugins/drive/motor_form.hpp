#pragma once

#include <bodeflow/block.hpp>

#include "motor_parameters.hpp"

namespace bodeflow::drive {

/// Describes the parameters of every form of MotorParameters.
void describe_motor_form(Describe& d);

/// The motor in the form that is given. Throws Failure when the parameters given are not those of one form.
MotorParameters read_motor_form(const Parameters& p);

}  // namespace bodeflow::drive
