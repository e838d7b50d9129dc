#pragma once

#include <string>
#include <vector>

#include "identification.hpp"
#include "measured.hpp"

namespace bodeflow::maximum_likelihood {

/// What the user of a model should know, each with what to do about it.
std::vector<std::string> model_warnings(const Identification& id, const Measured& measured);

}  // namespace bodeflow::maximum_likelihood
