#include <fmt/format.h>
#include <unistd.h>

#include <cstring>

#include "commands/command.hpp"
#include "plugins/probe.hpp"

namespace bodeflow::tools {
namespace {

struct TestCommand {
  std::string file;
  std::string settings;
  std::string block;
  bool all = false;
};

/// The suite is a program of its own, which counts allocations and locks in place of the C library.
int test_plugin(const Session& session, const TestCommand& command) {
  std::error_code unknown;
  if (std::filesystem::exists(command.file, unknown) && !std::filesystem::is_regular_file(command.file, unknown)) {
    say_error(fmt::format("{}: is not a regular file", command.file));
    return kPlugin;
  }
  constexpr double kProbeSeconds = 30.0;
  const PluginDescription plugin = probe(std::filesystem::absolute(command.file), session.executable, kProbeSeconds);
  if (!plugin.refused.empty()) {
    say_error(fmt::format("{}: {}", command.file, plugin.refused));
    return kPlugin;
  }
  const std::string suite = (session.executable.parent_path() / "bodeflow-conformance").string();
  std::vector<std::string> words{suite, command.file};
  if (!command.settings.empty()) words.insert(words.end(), {"--settings", command.settings});
  if (!command.block.empty()) words.insert(words.end(), {"--block", command.block});
  if (command.all) words.emplace_back("--all");
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(suite.c_str(), arguments.data());
  say_error(fmt::format("can't start '{}': {}", suite, std::strerror(errno)));
  return kRunFailed;
}

}  // namespace

void add_test_plugin(CLI::App& app, Session& session) {
  auto* command =
      app.add_subcommand("test-plugin", "Test a plugin against its contract: life cycle, bit-identity, claims, bad values");
  auto options = std::make_shared<TestCommand>();
  command->add_option("file", options->file, "The plugin: a shared library")->required();
  command->add_option("--settings", options->settings, "A file with parameters to test, a line each: example.gain: gain = 2")
      ->type_name("FILE");
  command->add_option("--block", options->block, "This block alone")->type_name("ID");
  command->add_flag("--all", options->all, "List what passed as well");
  command->callback([&session, options] { session.action = [&session, options] { return test_plugin(session, *options); }; });
}

}  // namespace bodeflow::tools
