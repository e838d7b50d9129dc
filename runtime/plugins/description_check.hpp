#pragma once

#include <string>

#include "plugins/description.hpp"

namespace bodeflow {

/// Bounds that a description keeps; a plugin beyond them is broken or hostile.
inline constexpr std::uint32_t kMostPorts = 1024;
inline constexpr std::uint32_t kMostParameters = 4096;
inline constexpr std::uint32_t kMostChoices = 4096;
inline constexpr std::uint64_t kMostValues = 1U << 20U;

/// What is wrong with a description, wherever it came from, or "": ids and names, kinds, types, ranges, defaults, repeats.
std::string check(const BlockDescription& block);
std::string check_base_model(const BlockDescription& model);
std::string check(const EffectDescription& effect);

}  // namespace bodeflow
