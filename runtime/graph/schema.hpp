#pragma once

#include <nlohmann/json.hpp>

#include "plugins/registry.hpp"

namespace bodeflow::graph {

/// JSON Schema (draft-07) of graph files with the blocks of a registry: editors complete keys, block ids and parameters with
/// it, and show what each means, its unit, range and default. Names that one part of a file
/// gives to another (ends of connections, variables) are checked by `load` alone.
nlohmann::ordered_json schema(const Registry& registry);

}  // namespace bodeflow::graph
