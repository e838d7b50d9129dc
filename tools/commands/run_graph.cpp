#include "commands/run_graph.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <set>

#include "commands/interrupt.hpp"
#include "commands/plans.hpp"
#include "commands/vector_level.hpp"
#include "console/console.hpp"
#include "live/state_json.hpp"
#include "live/view.hpp"
#include "report/report.hpp"
#include "transport/service.hpp"

namespace bodeflow::tools {
namespace {

nlohmann::json manifest_of(const graph::Graph& graph, const Registry& registry, const RunGraph& options) {
  std::set<std::string> seen;
  nlohmann::json plugins = nlohmann::json::array();
  for (const auto& phase : graph.phases)
    for (const auto& block : phase.blocks) {
      const PluginDescription* plugin = registry.plugin_of(block.type->id);
      if (plugin != nullptr && seen.insert(plugin->name).second)
        plugins.push_back({{"name", plugin->name},
                           {"version", plugin->version},
                           {"file", plugin->file},
                           {"sha256", plugin->sha256},
                           {"build", plugin->build}});
    }
  utsname system{};
  uname(&system);
  return {{"bodeflow", BODEFLOW_VERSION},
          {"abi", fmt::format("{}.{}", BF_ABI_MAJOR, BF_ABI_MINOR)},
          {"graph", graph.file},
          {"title", graph.title},
          {"command", options.command},
          {"vector_level", vector_level_name(options.vector_level)},
          {"host", system.nodename},
          {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
          {"plugins", plugins}};
}

void say_what_is_wrong(const Problems& problems, bool own_graph) {
  if (!own_graph) return say_problems(problems);
  for (const auto& problem : problems) say_error(problem.text);
}

void say_result(const phases::RunResult& result, const std::filesystem::path& directory, bool own_graph) {
  if (result.status == phases::RunResult::Status::complete) return;
  const std::string phase = result.phase.empty() ? "" : fmt::format("phase '{}': ", result.phase);
  if (result.status == phases::RunResult::Status::rejected)
    say_what_is_wrong(result.problems, own_graph);
  else if (result.status == phases::RunResult::Status::interrupted)
    say_warning(phase + "interrupted; what was recorded is kept");
  else
    say_error(phase + (result.block.empty() ? "" : fmt::format("block '{}': ", result.block)) + result.reason);
  say(fmt::format("partial run: {}", directory.string()));
}

/// report.html, where that takes a moment only; what goes wrong with it is no failure of the run.
void write_run_report(const std::filesystem::path& directory, const Registry& registry) {
  if (!report::is_quick(directory)) {
    say(fmt::format("large run: 'bodeflow report {}' writes its report", directory.string()));
    return;
  }
  try {
    const auto written = report::write_report({directory, {}}, registry);
    if (!written) say_warning("no report: " + written.error());
  } catch (const std::exception& error) {
    say_warning(std::string("no report: ") + error.what());
  }
}

void say_block(const std::string& block, int level, const std::string& text) {
  if (level >= BF_LOG_WARNING)
    say_warning(block + ": " + text);
  else if (level >= BF_LOG_INFO)
    say(block + ": " + text);
}

phases::RunResult run_over_hosts(const graph::Graph& graph, const Registry& registry, const RunGraph& options,
                                 record::RunDirectory& directory, ProgressLine& progress, const std::atomic<bool>& stop) {
  lab::LaunchOptions launch;
  launch.settings = *options.lab;
  launch.plan = options.plan;
  launch.vector_level = options.vector_level;
  launch.stop = &stop;
  launch.part_command = options.part_command;
  launch.version = BODEFLOW_VERSION;
  launch.progress = [&progress](const std::string& phase, const execute::Progress& now) { progress.show(phase, now); };
  launch.log = [&progress](const std::string& host, const std::string& block, int level, const std::string& text) {
    progress.clear();
    say_block(host.empty() ? block : host + ": " + block, level, text);
  };
  return lab::launch(graph, registry, directory, launch);
}

/// What became of changes that were asked for by hand: for the console, the log and the page.
void tell_changes(live::View& view, record::RunDirectory& directory, ProgressLine& progress) {
  for (const observe::Change& change : view.watch().news()) {
    const bool taken = change.status == observe::Change::Status::taken;
    const std::string text = live::change_text(change);
    const int level = taken ? BF_LOG_INFO : BF_LOG_WARNING;
    directory.log("live", level, text);
    if (!taken)
      directory.event("parameter not changed",
                      {{"phase", change.phase}, {"repeat", change.repeat}, {"reason", text}, {"by", "live"}});
    progress.clear();
    say_block("live", level, text);
  }
}

void log_warnings(live::View& view, const std::vector<phases::Prepared>& prepared) {
  for (const auto& phase : prepared) {
    for (const auto& warning : phase.facts.warnings) view.log("graph", BF_LOG_WARNING, warning);
    for (const auto& [block, said] : phase.advice)
      if (said.level >= BF_LOG_WARNING) view.log(block, said.level, said.text);
  }
}

}  // namespace

int exit_code_of(phases::RunResult::Status status) {
  switch (status) {
    case phases::RunResult::Status::complete:
      return kDone;
    case phases::RunResult::Status::interrupted:
      return kInterrupted;
    case phases::RunResult::Status::rejected:
      return kRejected;
    case phases::RunResult::Status::unreachable:
    case phases::RunResult::Status::device:
      return kDevice;
    case phases::RunResult::Status::limit:
      return kLimitViolated;
    default:
      return kRunFailed;
  }
}

RanGraph run_graph(const graph::Graph& graph, Registry& registry, const RunGraph& options) {
  ProgressLine progress;
  std::unique_ptr<live::View> view;  // outlives all that it shows
  if (options.live) {
    auto opened = live::View::open(*options.live, graph);
    if (!opened) {
      say_error("--live: " + opened.error());
      return {kDevice, {}, {}};
    }
    view = std::move(*opened);
  }
  const std::atomic<bool>* stopped = nullptr;
  const transport::Service topics({}, [&stopped] { return stopped == nullptr || !*stopped; });  // outlives the blocks
  phases::Services services([&progress, &view](const std::string& block, int level, const std::string& text) {
    progress.clear();
    say_block(block, level, text);
    if (view) view->log(block, level, text);
  });
  services.provide(BF_EXTENSION_TRANSPORT, &topics.c());
  std::vector<phases::Prepared> prepared;
  if (!options.lab) {
    auto all = phases::prepare_all(graph, registry, services, options.plan);
    if (!all) {
      say_what_is_wrong(all.error(), options.own_graph);
      return {kRejected, {}, {}};
    }
    prepared = std::move(*all);
    say_warnings(prepared);
    if (view) log_warnings(*view, prepared);
  }

  auto directory = record::RunDirectory::create(
      {options.out, options.graph_name.empty() ? std::filesystem::path(graph.file).stem().string() : options.graph_name,
       manifest_of(graph, registry, options)},
      graph);
  if (!directory) {
    say_error(directory.error());
    return {kRunFailed, {}, {}};
  }
  const std::atomic<bool>& stop = stop_on_interrupt();  // until here there is nothing to keep
  services.attach(**directory);
  stopped = &stop;
  if (view) {
    view->begins((*directory)->path());
    say("Live: " + view->address());
  }

  phases::RunResult result;
  if (options.lab) {
    result = run_over_hosts(graph, registry, options, **directory, progress, stop);
  } else {
    phases::RunOptions run;
    run.plan = options.plan;
    run.vector_level = options.vector_level;
    run.stop = &stop;
    run.command = options.executable;
    run.plugin_path = options.plugin_path;
    run.past_changes = options.past_changes;
    if (view) run.watch = &view->watch();
    run.progress = [&](const std::string& phase, const execute::Progress& now) {
      progress.show(phase, now);
      if (!view) return;
      view->watch().sweep_progress(now);
      tell_changes(*view, **directory, progress);
    };
    result = phases::run(graph, std::move(prepared), registry, **directory, services, run);
  }
  progress.clear();
  if (view) tell_changes(*view, **directory, progress);

  const auto closed = (*directory)->close(phases::status_word(result.status), result.reason);
  RanGraph ran{exit_code_of(result.status), (*directory)->path(), (*directory)->result()};
  say_result(result, ran.directory, options.own_graph);
  if (!closed) {
    say_error(closed.error());
    if (ran.exit_code == kDone) ran.exit_code = kRunFailed;
  }
  if (result.hung) std::_Exit(ran.exit_code);
  if (view) view->ends(phases::status_word(result.status), result.reason);
  if (closed) write_run_report(ran.directory, registry);
  return ran;
}

}  // namespace bodeflow::tools
