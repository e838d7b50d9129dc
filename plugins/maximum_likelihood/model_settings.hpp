#pragma once

#include <bodeflow/block.hpp>

#include "identification.hpp"

namespace bodeflow::maximum_likelihood {

/// Describes the parameters that `read_settings` reads.
void describe_settings(Describe& d);

/// The settings of a block. Fails with the parameter's name, what was found and what is allowed.
Settings read_settings(const Parameters& p);

}  // namespace bodeflow::maximum_likelihood
