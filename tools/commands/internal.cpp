#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "commands/command.hpp"
#include "commands/interrupt.hpp"
#include "commands/run_graph.hpp"
#include "lab/agents.hpp"
#include "lab/part_server.hpp"
#include "phases/sweep.hpp"
#include "plugins/probe.hpp"

namespace bodeflow::tools {
namespace {

void add_probe(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("probe-plugin", "Print the descriptors of a plugin file")->group("");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file)->required();
  command->callback([&session, file] { session.action = [file] { return probe_main(file->c_str()); }; });
}

struct WorkerCommand {
  phases::WorkerTask task;
  phases::RunOptions run;
  std::vector<std::string> sets;
  std::uint64_t seed = 0;
};

int work(const Session& session, WorkerCommand& command, bool seeded) {
  for (const auto& set : command.sets) {
    const auto equal = set.find('=');
    if (equal == std::string::npos) return kUsage;
    command.task.overrides.emplace_back(set.substr(0, equal), set.substr(equal + 1));
  }
  if (seeded) command.task.seed = command.seed;
  command.run.stop = &stop_on_interrupt();
  signal(SIGINT, SIG_IGN);  // of the terminal: the run that started this passes it on as SIGTERM
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  command.run.plan.threads = 1;
  Registry registry = session.open_registry();
  const phases::RunResult result = phases::run_worker(command.task, registry, command.run);
  if (result.status == phases::RunResult::Status::complete) return kDone;
  say(result.block.empty() ? result.reason : "block '" + result.block + "': " + result.reason);
  static_assert(phases::kDeviceEnded == kDevice);
  static_assert(phases::kLimitEnded == kLimitViolated);
  if (result.hung) std::_Exit(exit_code_of(result.status));
  return exit_code_of(result.status);
}

void add_worker(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("phase-worker", "Run one phase of a sweep")->group("");
  auto options = std::make_shared<WorkerCommand>();
  command->add_option("--graph", options->task.graph_file)->required();
  command->add_option("--phase", options->task.phase)->required();
  command->add_option("--out", options->task.directory)->required();
  command->add_option("--references", options->task.references)->required();
  command->add_option("--vector-level", options->run.vector_level);
  command->add_option("--set", options->sets)->allow_extra_args(false);
  auto* seed = command->add_option("--seed", options->seed);
  command->callback([&session, options, seed] {
    session.action = [&session, options, seeded = seed->count() > 0] { return work(session, *options, seeded); };
  });
}

struct PartCommand {
  lab::PartTask task;
  std::string host, settings;
  double memory_gb = 0.0;
};

int serve_part(const Session& session, PartCommand& command) {
  const std::atomic<bool>& stop = stop_on_interrupt();
  signal(SIGINT, SIG_IGN);  // of the terminal: the launcher passes it on in its own words
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (command.memory_gb > 0.0) {
    const auto bytes = static_cast<rlim_t>(command.memory_gb * 1e9);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
  }
  command.task.host = command.host == "-" ? "" : command.host;
  command.task.settings = lab::settings_from(nlohmann::json::parse(command.settings));
  command.task.settings.name = "bodeflow part " + command.host;
  Registry registry = session.open_registry();
  return lab::serve_part(command.task, registry, stop);
}

void add_part(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("part-worker", "Run one host's part of a graph")->group("");
  auto options = std::make_shared<PartCommand>();
  command->add_option("--run", options->task.run)->required();
  command->add_option("--host", options->host)->required();
  command->add_option("--directory", options->task.directory)->required();
  command->add_option("--settings", options->settings)->required();
  command->add_option("--memory", options->memory_gb);
  command->callback([&session, options] { session.action = [&session, options] { return serve_part(session, *options); }; });
}

}  // namespace

void add_internal(CLI::App& app, Session& session) {
  add_probe(app, session);
  add_worker(app, session);
  add_part(app, session);
}

}  // namespace bodeflow::tools
