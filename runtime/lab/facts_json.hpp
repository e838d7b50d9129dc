#pragma once

#include <nlohmann/json.hpp>

#include "plan/plan.hpp"

namespace bodeflow::lab {

// What the processes of a run tell each other about blocks and streams; doubles keep their bits.
nlohmann::json to_json(const StreamFacts& facts);
nlohmann::json to_json(const std::vector<StreamFacts>& facts);
nlohmann::json to_json(const Resolution& resolution);
nlohmann::json to_json(const plan::Facts& facts);
nlohmann::json to_json(const Problems& problems);

// Back; nlohmann::json::exception where something is missing or of another type.
std::vector<StreamFacts> stream_facts_from(const nlohmann::json& json);
Resolution resolution_from(const nlohmann::json& json);
plan::Facts facts_from(const nlohmann::json& json);
Problems problems_from(const nlohmann::json& json);

}  // namespace bodeflow::lab
