#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "console/console.hpp"
#include "graph/load.hpp"
#include "plugins/registry.hpp"

namespace bodeflow::tools {

/// What all commands share: where the plugins are, and which command was chosen.
struct Session {
  std::filesystem::path executable;      ///< our own file
  std::vector<std::string> plugin_path;  ///< --path, before the default places
  std::function<int()> action;           ///< of the command that was given

  Registry open_registry() const;
};

/// GRAPH and the options that change it: --set, --seed, --for.
struct GraphOptions {
  std::string file;
  std::vector<std::string> sets;
  std::string seed;
  std::string duration;
  bool json = false;

  void add_to(CLI::App& app);
  void add_json_to(CLI::App& app);
  /// The loaded graph; on failure says every problem and gives the exit code.
  tl::expected<graph::Graph, int> load(const Registry& registry) const;
  /// Says every problem, with --json also as JSON on standard output; gives the exit code.
  int reject(const Problems& problems) const;
};

// One function a command, each in the file of its name: adds itself to the application.
void add_run(CLI::App& app, Session& session);
void add_identify(CLI::App& app, Session& session);
void add_compare(CLI::App& app, Session& session);
void add_trace(CLI::App& app, Session& session);
void add_check(CLI::App& app, Session& session);
void add_plan(CLI::App& app, Session& session);
void add_graph(CLI::App& app, Session& session);
void add_expand(CLI::App& app, Session& session);
void add_plugins(CLI::App& app, Session& session);
void add_describe(CLI::App& app, Session& session);
void add_schema(CLI::App& app, Session& session);
void add_new(CLI::App& app, Session& session);
void add_test_plugin(CLI::App& app, Session& session);
void add_rerun(CLI::App& app, Session& session);
void add_report(CLI::App& app, Session& session);
void add_export(CLI::App& app, Session& session);
void add_trust(CLI::App& app, Session& session);
void add_agent(CLI::App& app, Session& session);
void add_hosts(CLI::App& app, Session& session);
void add_top(CLI::App& app, Session& session);
void add_doctor(CLI::App& app, Session& session);
void add_completion(CLI::App& app, Session& session);
void add_internal(CLI::App& app, Session& session);  ///< probe-plugin and phase-worker, which the engine itself calls

}  // namespace bodeflow::tools
