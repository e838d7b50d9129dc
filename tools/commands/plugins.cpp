#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {
namespace {

template <class Description>
nlohmann::ordered_json listed(const std::vector<Description>& descriptions) {
  nlohmann::ordered_json list = nlohmann::json::array();
  for (const auto& one : descriptions) list.push_back({{"id", one.id}, {"summary", one.summary}});
  return list;
}

template <class Description>
void print_list(const std::vector<Description>& descriptions, const char* kind) {
  for (const auto& one : descriptions) fmt::print("  {:<32} {}{}\n", one.id, dim(kind), one.summary);
}

int list_plugins(const Session& session, bool as_json) {
  const Registry registry = session.open_registry();
  nlohmann::ordered_json all = nlohmann::json::array();
  bool refused = false;
  for (const auto& plugin : registry.plugins()) {
    refused |= !plugin.refused.empty();
    if (as_json) {
      all.push_back({{"name", plugin.name},
                     {"version", plugin.version},
                     {"file", plugin.file},
                     {"build", plugin.build},
                     {"sha256", plugin.sha256},
                     {"refused", plugin.refused},
                     {"blocks", listed(plugin.blocks)},
                     {"effects", listed(plugin.effects)},
                     {"base_models", listed(plugin.base_models)}});
    } else if (!plugin.refused.empty()) {
      say_warning(fmt::format("{}: {}", plugin.file, plugin.refused));
    } else {
      fmt::print("{} {}  {}\n", bold(plugin.name), plugin.version, dim(plugin.file));
      print_list(plugin.blocks, "");
      print_list(plugin.effects, "effect: ");
      print_list(plugin.base_models, "base model: ");
    }
  }
  if (as_json) print_json(all);
  if (registry.plugins().empty()) say_warning("no plugins found; --path DIR or BODEFLOW_PLUGIN_PATH tells where they are");
  return refused ? kPlugin : kDone;
}

}  // namespace

void add_plugins(CLI::App& app, Session& session) {
  auto* command =
      app.add_subcommand("plugins", "List the plugins with their blocks, effects and base models, and why a file was refused");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON");
  command->callback([&session, json] { session.action = [&session, json] { return list_plugins(session, *json); }; });
}

}  // namespace bodeflow::tools
