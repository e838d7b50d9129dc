#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {
namespace {

int list_plugins(const Session& session, bool as_json) {
  const Registry registry = session.open_registry();
  nlohmann::ordered_json all = nlohmann::json::array();
  bool refused = false;
  for (const auto& plugin : registry.plugins()) {
    refused |= !plugin.refused.empty();
    if (as_json) {
      nlohmann::ordered_json blocks = nlohmann::json::array();
      for (const auto& block : plugin.blocks) blocks.push_back({{"id", block.id}, {"summary", block.summary}});
      all.push_back({{"name", plugin.name},
                     {"version", plugin.version},
                     {"file", plugin.file},
                     {"build", plugin.build},
                     {"sha256", plugin.sha256},
                     {"refused", plugin.refused},
                     {"blocks", blocks}});
    } else if (!plugin.refused.empty()) {
      say_warning(fmt::format("{}: {}", plugin.file, plugin.refused));
    } else {
      fmt::print("{} {}  {}\n", bold(plugin.name), plugin.version, dim(plugin.file));
      for (const auto& block : plugin.blocks) fmt::print("  {:<32} {}\n", block.id, block.summary);
    }
  }
  if (as_json) print_json(all);
  if (registry.plugins().empty()) say_warning("no plugins found; --path DIR or BODEFLOW_PLUGIN_PATH tells where they are");
  return refused ? kPlugin : kDone;
}

}  // namespace

void add_plugins(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("plugins", "List the plugins and their blocks, and why a file was refused");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON");
  command->callback([&session, json] { session.action = [&session, json] { return list_plugins(session, *json); }; });
}

}  // namespace bodeflow::tools
