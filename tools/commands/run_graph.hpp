#pragma once

#include <nlohmann/json.hpp>

#include "lab/launch.hpp"

namespace bodeflow::tools {

struct RunGraph {
  std::filesystem::path out;  ///< run directory; empty: below runs/
  std::string graph_name;     ///< empty: the file's, without its extension
  phases::PlanSettings plan;
  std::uint32_t vector_level = 1;
  nlohmann::json command;            ///< what `rerun` must repeat, for the manifest
  std::filesystem::path executable;  ///< our own, for the workers of sweeps, with their --path
  std::vector<std::string> plugin_path;
  std::vector<std::string> part_command;          ///< of this machine's own part in a lab
  std::optional<transport::Settings> lab;         ///< the graph's blocks run on the hosts that it names
  std::vector<phases::PastChanges> past_changes;  ///< made by hand in the run that is repeated
  std::optional<int> live;                        ///< port of the live page, 0: any
  bool own_graph = false;                         ///< nobody wrote the graph file: what is wrong with it is said without places
};

struct RanGraph {
  int exit_code = 0;
  std::filesystem::path directory;  ///< empty: nothing was run
  nlohmann::ordered_json result;    ///< as result.json
};

/// How a process ends whose run ended so.
int exit_code_of(phases::RunResult::Status status);

/// Checks, runs and records a graph; says on standard error what went wrong. Used by `run` and `rerun`.
RanGraph run_graph(const graph::Graph& graph, Registry& registry, const RunGraph& options);

}  // namespace bodeflow::tools
