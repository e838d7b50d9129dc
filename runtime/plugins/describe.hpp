#pragma once

#include <string>
#include <tl/expected.hpp>

#include "plugins/description.hpp"

namespace bodeflow {

/// An owned copy of a plugin's static descriptor, checked. Error: what is wrong with it.
tl::expected<BlockDescription, std::string> describe(const bf_block_descriptor& descriptor);
tl::expected<BlockDescription, std::string> describe_base_model(const bf_block_descriptor& descriptor);
tl::expected<EffectDescription, std::string> describe(const bf_effect_descriptor& descriptor);

}  // namespace bodeflow
