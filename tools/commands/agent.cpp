#include <fmt/format.h>

#include "commands/interrupt.hpp"
#include "commands/lab_options.hpp"
#include "trust/lab.hpp"

namespace bodeflow::tools {
namespace {

/// Where an agent keeps runs until their launcher fetches them.
std::filesystem::path default_directory() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state != '\0')
    return std::filesystem::path(state) / "bodeflow";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return std::filesystem::path(home) / ".local/state/bodeflow";
  return std::filesystem::temp_directory_path() / "bodeflow";
}

}  // namespace

int serve_lab(const Session& session, const AgentCommand& command) {
  if (const std::string problem = trust::name_problem(command.name); !problem.empty()) {
    say_error(fmt::format("--name '{}': {}", command.name, problem));
    return kUsage;
  }
  const Registry registry = session.open_registry();
  lab::AgentTask task;
  task.info = this_machine(session, registry, command.name);
  task.directory =
      std::filesystem::absolute(command.directory.empty() ? default_directory() : std::filesystem::path(command.directory));
  task.command = part_command(session);
  if (command.memory_gb > 0.0) {
    task.command.push_back("--memory");
    task.command.push_back(fmt::format("{}", command.memory_gb));
  }
  task.once = command.once;
  task.tell = [](const std::string& line) { say(line); };
  task.take_revocations = [&command](const std::string& pem) {
    const auto taken = trust::take_revocations(command.lab.trust_folder(), pem);
    if (!taken) say_warning(taken.error());
    return taken && *taken;
  };
  while (true) {
    auto settings = command.lab.settings(command.name);  // each time: this host may be revoked by now
    if (!settings) {
      say_error(settings.error());
      return kUsage;
    }
    task.settings = std::move(*settings);
    const auto again = lab::serve_agent(task, stop_on_interrupt());
    if (!again) {
      say_error(again.error());
      return kDevice;
    }
    if (!*again) return kDone;
    say("a new list of revoked hosts has come: joining anew");
  }
}

std::vector<std::string> part_command(const Session& session) {
  std::vector<std::string> command = {session.executable.string()};
  for (const std::string& folder : session.plugin_path) {
    command.push_back("--path");
    command.push_back(std::filesystem::absolute(folder).string());
  }
  command.push_back("part-worker");
  return command;
}

void add_agent(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("agent", "Serve the lab: run the parts of graphs that are placed on this machine");
  auto options = std::make_shared<AgentCommand>();
  command->add_option("--name", options->name, "This machine's name in graphs")->required();
  command->add_option("--runs", options->directory, "Runs are kept below it until they are fetched")->type_name("DIR");
  command->add_option("--memory", options->memory_gb, "Most memory of one run [GB]")->check(CLI::PositiveNumber);
  options->lab.add_to(*command);
  command->callback([&session, options] { session.action = [&session, options] { return serve_lab(session, *options); }; });
}

}  // namespace bodeflow::tools
