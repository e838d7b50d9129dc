#include "commands/past_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "graph/live_value.hpp"

namespace bodeflow::tools {
namespace {

using nlohmann::json;
using Failed = tl::unexpected<std::string>;

bool is_change_by_hand(const json& event) {
  return event.is_object() && event.value("event", json()) == "parameter changed" && event.value("by", json()) == "live";
}

tl::expected<execute::PastChange, std::string> change_of(const json& event, const graph::Phase& phase) {
  const auto text = [&](const char* key) { return event.value(key, json()).is_string() ? event[key].get<std::string>() : ""; };
  execute::PastChange change;
  change.block = phase.block_index(text("block"));
  if (change.block < 0) return Failed(fmt::format("the graph has no block '{}'", text("block")));
  const BlockDescription& type = *phase.blocks[static_cast<std::size_t>(change.block)].type;
  change.parameter = type.parameter(text("parameter"));
  if (change.parameter < 0 || !type.parameters[static_cast<std::size_t>(change.parameter)].live)
    return Failed(fmt::format("block '{}' has no live parameter '{}'", text("block"), text("parameter")));
  const json position = event.value("position", json()), value = event.value("value", json());
  if (!position.is_number_unsigned()) return Failed(std::string("a change has no position"));
  change.position = position.get<std::int64_t>();
  auto read = graph::read_live_value(type.parameters[static_cast<std::size_t>(change.parameter)],
                                     fmt::format("{}.{}", text("block"), text("parameter")),
                                     value.is_string() ? value.get<std::string>() : value.dump(), "");
  if (!read) return Failed(read.error());
  change.value = std::move(*read);
  return change;
}

}  // namespace

tl::expected<std::vector<phases::PastChanges>, std::string> read_past_changes(const std::filesystem::path& directory,
                                                                              const graph::Graph& graph) {
  std::vector<phases::PastChanges> all;
  std::ifstream file(directory / "events.jsonl");
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const auto damaged = [&](const std::string& why) {
      return Failed(fmt::format("{}:{}: {}", (directory / "events.jsonl").string(), number, why));
    };
    const json event = json::parse(line, nullptr, false);
    if (!is_change_by_hand(event)) continue;
    const json name = event.value("phase", json("")), repeat = event.value("repeat", json(0U));
    const auto phase = std::find_if(graph.phases.begin(), graph.phases.end(), [&](const auto& p) { return name == p.name; });
    if (phase == graph.phases.end() || !repeat.is_number_unsigned()) return damaged("a change in a phase that the graph lacks");
    auto change = change_of(event, *phase);
    if (!change) return damaged(change.error());
    const int times = repeat.get<int>();
    if (all.empty() || all.back().phase != phase->name || all.back().repeat != times) all.push_back({phase->name, times, {}});
    all.back().changes.push_back(std::move(*change));
  }
  return all;
}

}  // namespace bodeflow::tools
