#include <fmt/format.h>

#include <fstream>

#include "commands/command.hpp"
#include "commands/past_changes.hpp"
#include "commands/run_graph.hpp"
#include "commands/vector_level.hpp"
#include "console/json_output.hpp"
#include "plugins/sha256.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

tl::expected<nlohmann::json, std::string> read_manifest(const fs::path& directory) {
  std::ifstream file(directory / "manifest.json");
  if (!file) return tl::unexpected(fmt::format("'{}' is no run directory: it has no manifest.json", directory.string()));
  auto manifest = nlohmann::json::parse(file, nullptr, false);
  if (!manifest.is_object()) return tl::unexpected(fmt::format("'{}' is damaged", (directory / "manifest.json").string()));
  return manifest;
}

/// What differs between the run and this machine, a line each: the numbers may then differ.
void warn_of_changes(const nlohmann::json& manifest, const Registry& registry) {
  const nlohmann::json plugins = manifest.value("plugins", nlohmann::json::array());
  for (const auto& plugin : plugins)
    for (const auto& found : registry.plugins())
      if (found.name == plugin.value("name", "") && found.sha256 != plugin.value("sha256", ""))
        say_warning(fmt::format("plugin '{}' is not the file of the run: {} then, {} now", found.name,
                                plugin.value("version", "?"), found.version));
  const nlohmann::json inputs = manifest.value("inputs", nlohmann::json::array());
  for (const auto& input : inputs) {
    const std::string path = input.value("path", "");
    const auto sum = sha256_of_file(path);
    if (!sum || *sum != input.value("sha256", "")) say_warning(fmt::format("input file '{}' has changed since the run", path));
  }
}

/// The outputs whose bits differ.
std::vector<std::string> differences(const nlohmann::json& before, const nlohmann::json& after) {
  const auto old_hashes = before.value("hashes", nlohmann::json::object()),
             new_hashes = after.value("hashes", nlohmann::json::object());
  std::vector<std::string> different;
  for (const auto& [name, hash] : old_hashes.items())
    if (!new_hashes.contains(name) || new_hashes[name] != hash) different.push_back(name);
  for (const auto& [name, hash] : new_hashes.items())
    if (!old_hashes.contains(name)) different.push_back(name);
  return different;
}

struct RerunCommand {
  std::string directory;
  std::string out;
  bool json = false;
};

int rerun(const Session& session, const RerunCommand& command) {
  const auto manifest = read_manifest(command.directory);
  if (!manifest) {
    say_error(manifest.error());
    return kUsage;
  }
  if (const std::string status = manifest->value("status", "?"); status != "complete") {
    say_error(fmt::format("the run in '{}' has the status '{}': only a complete run can be repeated and compared",
                          command.directory, status));
    return kUsage;
  }
  RunGraph options;
  options.vector_level = vector_level_of(manifest->value("vector_level", ""));
  if (options.vector_level == 0 || options.vector_level > processor_vector_level()) {
    say_error(fmt::format("the run used vector level '{}', this processor has {}", manifest->value("vector_level", ""),
                          vector_level_name(processor_vector_level())));
    return kRunFailed;
  }
  Registry registry = session.open_registry();
  warn_of_changes(*manifest, registry);
  const auto graph = graph::load((fs::path(command.directory) / "graph.yaml").string(), {}, registry);
  if (!graph) {
    say_problems(graph.error());
    return kRejected;
  }
  auto changes = read_past_changes(command.directory, *graph);
  if (!changes) {
    say_error(changes.error());
    return kRejected;
  }
  options.past_changes = std::move(*changes);
  options.command = manifest->value("command", nlohmann::json::object());
  if (const int threads = options.command.value("threads", 0); threads > 0) options.plan.threads = threads;
  if (const std::int64_t chunk = options.command.value("chunk", std::int64_t{0}); chunk > 0) options.plan.chunk = chunk;
  options.out = command.out;
  options.graph_name = manifest->value("graph", "");
  options.executable = session.executable;
  options.plugin_path = session.plugin_path;
  const RanGraph ran = run_graph(*graph, registry, options);
  if (ran.exit_code != kDone) return ran.exit_code;

  const auto again = read_manifest(ran.directory);
  if (!again) {
    say_error(again.error());
    return kRunFailed;
  }
  const auto different = differences(*manifest, *again);
  const std::size_t count = again->value("hashes", nlohmann::json::object()).size();
  if (count == 0 && different.empty()) {
    say_error("the run kept nothing that could be compared; 'record: all' in the graph keeps every stream");
    return kRunFailed;
  }
  if (command.json)
    print_json(nlohmann::ordered_json{{"directory", ran.directory.string()}, {"outputs", count}, {"different", different}});
  else if (different.empty())
    fmt::print("{} outputs, all identical bit for bit\nRun directory: {}\n", count, ran.directory.string());
  if (different.empty()) return kDone;
  say_error(fmt::format("not identical: {}", fmt::join(different, ", ")));
  return kRunFailed;
}

}  // namespace

void add_rerun(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("rerun", "Repeat a run from its run directory and compare every output bit for bit");
  auto options = std::make_shared<RerunCommand>();
  command->add_option("directory", options->directory, "The run directory")->required();
  command->add_option("--out", options->out, "Run directory of the repetition")->type_name("DIR");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([&session, options] { session.action = [&session, options] { return rerun(session, *options); }; });
}

}  // namespace bodeflow::tools
