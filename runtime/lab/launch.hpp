#pragma once

#include "lab/agents.hpp"
#include "phases/run.hpp"

namespace bodeflow::lab {

struct LaunchOptions {
  transport::Settings settings;
  phases::PlanSettings plan;
  std::uint32_t vector_level = 1;
  const std::atomic<bool>* stop = nullptr;
  std::vector<std::string> part_command;  ///< of the process of this machine's own part
  std::string version;                    ///< which all hosts must have
  std::function<void(const std::string& phase, const execute::Progress&)> progress;
  std::function<void(const std::string& host, const std::string& block, int level, const std::string& text)> log;
};

/// Runs a graph whose blocks lie on several hosts: starts a process for each host's part, resolves and lays out each phase with
/// them, starts them together, watches them, and brings what they left into `directory`, as if it had run here.
///
/// Before anything starts all hosts are there, with the same version and the same plugins, and can use `vector_level`. The first
/// failure stops all; so does a host that is not heard of for ten seconds.
phases::RunResult launch(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory,
                         const LaunchOptions& options);

/// Whether any block lies on another machine.
bool has_hosts(const graph::Graph& graph);

}  // namespace bodeflow::lab
