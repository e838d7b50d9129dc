#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>

#include "plugins/description.hpp"

namespace bodeflow {

/// A block's description as JSON, in the words of a graph: kinds, directions, elements and types by name; defaults as plain
/// values (absent: none); a free end of a range is left out; non-finite numbers are the texts "inf", "-inf", "nan".
nlohmann::ordered_json to_json(const BlockDescription& block);

/// And back, checked as a plugin's own description is. Error: what is wrong with the JSON, whatever it holds.
tl::expected<BlockDescription, std::string> from_json(const nlohmann::ordered_json& json);

/// The same for a base model, and for an effect.
nlohmann::ordered_json base_model_to_json(const BlockDescription& model);
tl::expected<BlockDescription, std::string> base_model_from_json(const nlohmann::ordered_json& json);
nlohmann::ordered_json to_json(const EffectDescription& effect);
tl::expected<EffectDescription, std::string> effect_from_json(const nlohmann::ordered_json& json);

/// A plugin's description as JSON: file, name, version, build, sha256, and either blocks, effects and base models or why it is
/// refused.
nlohmann::ordered_json to_json(const PluginDescription& plugin);

/// And back. Error: what is wrong with the JSON, whatever it holds.
tl::expected<PluginDescription, std::string> plugin_from_json(const nlohmann::ordered_json& json);

/// "number", "choice" ... for BF_NUMBER, BF_CHOICE ...; "unknown" otherwise.
const char* parameter_type_name(std::uint32_t type);

/// "f64", "c64", "i64", "u8", "any" for an element type; "unknown" otherwise.
const char* element_name(std::uint32_t element);

}  // namespace bodeflow
