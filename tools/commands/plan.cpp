

#include "commands/command.hpp"
#include "commands/plans.hpp"
#include "phases/run.hpp"

namespace bodeflow::tools {
namespace {

struct PlanCommand {
  GraphOptions graph;
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
  if (!prepared) return command.graph.reject(prepared.error());
  say_warnings(*prepared);
  print_plans(*graph, *prepared, command.graph.json);
  return kDone;
}

}  // namespace

void add_plan(CLI::App& app, Session& session) {
  auto* command =
      app.add_subcommand("plan", "Show what the engine will do: order of calls, chunks, buffers, threads, latency, memory");
  auto options = std::make_shared<PlanCommand>();
  options->graph.add_to(*command);
  options->graph.add_json_to(*command);
  command->add_option("--threads", options->threads, "Most threads")->check(CLI::Range(1, 256));
  command->add_option("--chunk", options->chunk, "Samples of the fastest stream in one call, at most")
      ->check(CLI::Range(1, 1 << 20));
  command->callback([&session, options] { session.action = [&session, options] { return plan(session, *options); }; });
}

}  // namespace bodeflow::tools
