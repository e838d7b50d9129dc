#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "phases/run.hpp"

namespace bodeflow::tools {
namespace {

int check(const Session& session, const GraphOptions& options, bool as_json) {
  Registry registry = session.open_registry();
  const auto graph = options.load(registry);
  if (!graph) return graph.error();
  phases::Services services([](const std::string& block, int level, const std::string& text) {
    if (level >= BF_LOG_INFO) say(block + ": " + text);
  });
  const auto prepared = phases::prepare_all(*graph, registry, services, {});
  if (!prepared) {
    say_problems(prepared.error());
    return kRejected;
  }
  nlohmann::ordered_json phases = nlohmann::json::array();
  for (std::size_t i = 0; i < graph->phases.size(); ++i) {
    const auto& phase = graph->phases[i];
    for (const auto& warning : (*prepared)[i].facts.warnings) say_warning(warning);
    phases.push_back({{"name", phase.name},
                      {"blocks", phase.blocks.size()},
                      {"connections", phase.streams.size() + phase.messages.size()},
                      {"warnings", (*prepared)[i].facts.warnings}});
    if (!as_json)
      fmt::print("{}{}: {} blocks, {} connections, right\n", options.file,
                 phase.name.empty() ? "" : ", phase '" + phase.name + "'", phase.blocks.size(),
                 phase.streams.size() + phase.messages.size());
  }
  if (as_json) fmt::print("{}\n", nlohmann::ordered_json{{"graph", options.file}, {"phases", phases}}.dump(2));
  return kDone;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("check", "Say everything that is wrong with a graph, without running it");
  auto options = std::make_shared<GraphOptions>();
  auto json = std::make_shared<bool>(false);
  options->add_to(*command);
  command->add_flag("--json", *json, "Print JSON");
  command->callback(
      [&session, options, json] { session.action = [&session, options, json] { return check(session, *options, *json); }; });
}

}  // namespace bodeflow::tools
