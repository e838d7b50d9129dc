#pragma once

#include <bodeflow/abi.h>

#include <string>
#include <vector>

namespace bodeflow::testing {

/// What is wrong with a plugin's entry and factories; empty: nothing.
std::vector<std::string> plugin_problems(const bf_plugin& plugin, const bf_factory* const* factories, std::uint32_t count);

/// What is wrong with the static descriptor of a block or a base model; empty: nothing.
std::vector<std::string> descriptor_problems(const bf_factory& factory);

/// What is wrong with an effect's static descriptor; empty: nothing.
std::vector<std::string> effect_problems(const bf_factory& factory);

}  // namespace bodeflow::testing
