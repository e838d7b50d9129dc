#pragma once

#include <string>
#include <tl/expected.hpp>

#include "plugins/registry.hpp"

namespace bodeflow::tools {

/// The block of role `identifier` that a word means: its id, the last part of its id where that is unique, or its family
/// (its block called `model`, or its only identifier). Error: none or several, with all methods there are.
tl::expected<const BlockDescription*, std::string> method_named(const Registry& registry, const std::string& word);

/// All blocks of role `identifier`, a line each with what they do.
std::string method_list(const Registry& registry);

}  // namespace bodeflow::tools
