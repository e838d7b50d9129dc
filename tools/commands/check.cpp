#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "commands/plans.hpp"
#include "console/json_output.hpp"
#include "phases/run.hpp"

namespace bodeflow::tools {
namespace {

nlohmann::ordered_json advice_json(const std::vector<phases::Advice>& advice) {
  nlohmann::ordered_json list = nlohmann::json::array();
  for (const auto& [block, said] : advice)
    list.push_back({{"block", block}, {"level", said.level >= BF_LOG_WARNING ? "warning" : "info"}, {"text", said.text}});
  return list;
}

int check(const Session& session, const GraphOptions& options) {
  Registry registry = session.open_registry();
  const auto graph = options.load(registry);
  if (!graph) return graph.error();
  phases::Services services([](const std::string& block, int level, const std::string& text) {
    if (level >= BF_LOG_INFO) say(block + ": " + text);
  });
  const auto prepared = phases::prepare_all(*graph, registry, services, {});
  if (!prepared) return options.reject(prepared.error());
  say_warnings(*prepared);
  nlohmann::ordered_json phases = nlohmann::json::array();
  for (std::size_t i = 0; i < graph->phases.size(); ++i) {
    const auto& phase = graph->phases[i];
    phases.push_back({{"name", phase.name},
                      {"blocks", phase.blocks.size()},
                      {"connections", phase.streams.size() + phase.messages.size()},
                      {"warnings", (*prepared)[i].facts.warnings},
                      {"advice", advice_json((*prepared)[i].advice)}});
    if (options.json) continue;
    fmt::print("{}{}: {} blocks, {} connections, right\n", options.file, phase.name.empty() ? "" : ", phase '" + phase.name + "'",
               phase.blocks.size(), phase.streams.size() + phase.messages.size());
    for (const auto& [block, said] : (*prepared)[i].advice)
      if (said.level < BF_LOG_WARNING) fmt::print("  {}: {}\n", block, said.text);
  }
  if (options.json) print_json(nlohmann::ordered_json{{"graph", options.file}, {"phases", phases}});
  return kDone;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("check", "Say everything that is wrong with a graph, without running it");
  auto options = std::make_shared<GraphOptions>();
  options->add_to(*command);
  options->add_json_to(*command);
  command->callback([&session, options] { session.action = [&session, options] { return check(session, *options); }; });
}

}  // namespace bodeflow::tools
