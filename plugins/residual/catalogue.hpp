#pragma once

#include <memory>
#include <string>
#include <vector>

#include "effect.hpp"
#include "expected.hpp"

namespace bodeflow::residual {

using Catalogue = std::vector<std::unique_ptr<const Effect>>;

/// The effects of these names, in this order; all there are where no name is given. Errors: an unknown name or one given twice.
Expected<Catalogue> catalogue(const std::vector<std::string>& names = {});

/// The names of all effects.
std::vector<std::string> effect_names();

}  // namespace bodeflow::residual
