#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/command.hpp"
#include "phases/run.hpp"

namespace bodeflow::tools {
namespace {

struct PlanCommand {
  GraphOptions graph;
  bool json = false;
  int threads = 0;
  std::int64_t chunk = 0;
};

int plan(const Session& session, const PlanCommand& command) {
  Registry registry = session.open_registry();
  const auto graph = command.graph.load(registry);
  if (!graph) return graph.error();
  phases::PlanSettings settings;
  if (command.threads > 0) settings.threads = command.threads;
  if (command.chunk > 0) settings.chunk = command.chunk;
  const auto prepared = phases::prepare_all(*graph, registry, phases::Services(), settings);
  if (!prepared) {
    say_problems(prepared.error());
    return kRejected;
  }
  nlohmann::ordered_json all = nlohmann::json::array();
  for (std::size_t i = 0; i < graph->phases.size(); ++i) {
    const auto& phase = graph->phases[i];
    const auto& [instances, facts, plan] = (*prepared)[i];
    if (command.json) {
      all.push_back({{"phase", phase.name}, {"plan", plan::to_json(phase, facts, plan)}});
    } else {
      if (!phase.name.empty()) fmt::print("{}\n", bold("phase " + phase.name));
      fmt::print("{}", plan::to_text(phase, facts, plan));
    }
  }
  if (command.json) fmt::print("{}\n", all.dump(2));
  return kDone;
}

}  // namespace

void add_plan(CLI::App& app, Session& session) {
  auto* command =
      app.add_subcommand("plan", "Show what the engine will do: order of calls, chunks, buffers, threads, latency, memory");
  auto options = std::make_shared<PlanCommand>();
  options->graph.add_to(*command);
  command->add_flag("--json", options->json, "Print JSON");
  command->add_option("--threads", options->threads, "Most threads")->check(CLI::Range(1, 256));
  command->add_option("--chunk", options->chunk, "Samples of the fastest stream in one call, at most")
      ->check(CLI::Range(1, 1 << 20));
  command->callback([&session, options] { session.action = [&session, options] { return plan(session, *options); }; });
}

}  // namespace bodeflow::tools
