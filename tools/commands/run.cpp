#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>

#include "commands/command.hpp"
#include "commands/dry_run.hpp"
#include "commands/lab_options.hpp"
#include "commands/run_graph.hpp"
#include "commands/vector_level.hpp"
#include "console/json_output.hpp"
#include "console/summary.hpp"

namespace bodeflow::tools {
namespace {

struct RunCommand {
  GraphOptions graph;
  std::string out;
  int threads = 0;
  std::int64_t chunk = 0;
  std::string isa;
  bool dry_run = false;
  bool here = false;
  std::string host;
  std::string live;
  LabOptions lab;
};

constexpr const char* kFreePort = "true";  ///< what a flag without a value is

/// The port of --live, 0 for any that is free; -1: no port.
int live_port(const std::string& text) {
  if (text == kFreePort) return 0;
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port >= 1 && port <= 65535 ? port : -1;
}

/// The port of the page that was asked for, or nothing; false, and said: there can be none.
bool read_live(const RunCommand& command, bool over_hosts, RunGraph& options) {
  if (command.live.empty()) return true;
  const int port = live_port(command.live);
  if (port < 0) {
    say_error(fmt::format("--live={}: allowed is a port from 1 to 65535, or --live alone for any that is free", command.live));
    return false;
  }
  if (over_hosts) {
    say_error(
        "--live shows what this process runs, and here blocks run on other hosts: 'bodeflow top' shows those; with --here "
        "all blocks run in this process");
    return false;
  }
  options.live = port;
  return true;
}

int run(const Session& session, const RunCommand& command) {
  RunGraph options;
  if (!command.host.empty()) {
    if (!read_live(command, true, options)) return kUsage;
    return serve_lab(session, {command.lab, command.host, "", 0.0, true});
  }
  options.vector_level = command.isa.empty() ? processor_vector_level() : vector_level_of(command.isa);
  if (options.vector_level > processor_vector_level()) {
    say_error(fmt::format("--isa {}: this processor has {}", command.isa, vector_level_name(processor_vector_level())));
    return kUsage;
  }
  Registry registry = session.open_registry();
  const auto graph = command.graph.load(registry);
  if (!graph) return graph.error();
  if (command.threads > 0) options.plan.threads = command.threads;
  if (command.chunk > 0) options.plan.chunk = command.chunk;
  if (command.dry_run) return dry_run(command.graph, *graph, registry, options.plan);

  const bool over_hosts = lab::has_hosts(*graph) && !command.here;
  if (!read_live(command, over_hosts, options)) return kUsage;
  options.out = command.out;
  options.executable = session.executable;
  options.plugin_path = session.plugin_path;
  options.command = {{"threads", command.threads}, {"chunk", command.chunk}};
  if (over_hosts) {
    auto settings = command.lab.settings("");
    if (!settings) {
      say_error(settings.error() + ", or --here (all blocks in this process)");
      return kUsage;
    }
    options.lab = std::move(*settings);
    options.part_command = part_command(session);
  }
  const RanGraph ran = run_graph(*graph, registry, options);
  if (ran.directory.empty()) return ran.exit_code;
  if (command.graph.json) {
    nlohmann::ordered_json printed = ran.result;
    printed["directory"] = ran.directory.string();
    print_json(printed);
  } else if (ran.exit_code == kDone) {
    if (!graph->title.empty()) fmt::print("{}\n", bold(graph->title));
    print_summary(ran.result, graph->summary.show);
    fmt::print("Run directory: {}\n", ran.directory.string());
    const std::filesystem::path page = ran.directory / "report.html";
    if (std::filesystem::exists(page)) fmt::print("Report: {}\n", page.string());
    if (!graph->summary.next.empty()) fmt::print("{}\n", graph->summary.next);
  }
  return ran.exit_code;
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("run", "Run a graph and keep what it gives in a run directory");
  auto options = std::make_shared<RunCommand>();
  options->graph.add_to(*command);
  command->add_option("--out", options->out, "Run directory (runs/<time>-<graph> otherwise)")->type_name("DIR");
  command->add_option("--threads", options->threads, "Most threads")->check(CLI::Range(1, 256));
  command->add_option("--chunk", options->chunk, "Samples of the fastest stream in one call, at most")
      ->check(CLI::Range(1, 1 << 20));
  command->add_option("--isa", options->isa, "Widest vector unit of kernels (this processor's otherwise)")
      ->check(CLI::IsMember(vector_level_names()));
  command->add_flag("--dry-run", options->dry_run,
                    "Show plan, devices, signals, limits and the largest excitation; move nothing");
  command->add_option("--host", options->host, "Serve one run as this host of the graph, by hand, in place of an agent")
      ->type_name("NAME");
  command->add_flag("--here", options->here, "All blocks in this process, whatever hosts the graph names");
  command->add_flag(
      "--live", options->live,
      "Show the run in a browser on this machine, where live parameters can be changed; --live=PORT for a port of your own");
  options->lab.add_to(*command);
  options->graph.add_json_to(*command);
  command->callback([&session, options] { session.action = [&session, options] { return run(session, *options); }; });
}

}  // namespace bodeflow::tools
