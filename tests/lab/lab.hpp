#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "system/command.hpp"
#include "transport/processes.hpp"

namespace bodeflow::test {

/// Agents in processes of their own and runs of graphs over them, in a lab that no other test shares.
class TestLab {
 public:
  /// The network options of every command: this machine alone.
  TestLab() : options_{"--loopback", "--domain", std::to_string(test_domain())} {}
  explicit TestLab(std::vector<std::string> options) : options_(std::move(options)) {}

  /// Starts an agent; `before` stands in front of the command (a namespace), `more` behind it. Returns when it is there.
  Process& agent(const std::string& name, const std::vector<std::string>& more = {}, const std::vector<std::string>& before = {});
  std::vector<std::string> agent_command(const std::string& name, const std::vector<std::string>& more = {}) const;
  /// The command `bodeflow run GRAPH` in this lab, with its messages on standard output.
  std::vector<std::string> run(const std::string& graph, const std::string& out, const std::vector<std::string>& more = {}) const;
  /// The same in one process.
  std::vector<std::string> run_here(const std::string& graph, const std::string& out) const;

  const Folder& folder() const { return folder_; }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// Hashes of all streams and records that a run kept.
  nlohmann::json hashes(const std::string& out) const;
  /// Folders of runs that an agent holds.
  std::vector<std::string> runs_of(const std::string& agent) const;
  /// Waits until an agent's part of a run knows its graph; false: not within ten seconds.
  bool has_graph(const std::string& agent) const;
  /// Ends the process of an agent, and with it all that it runs, as a crash does.
  void crash(const std::string& agent) const;

 private:
  Folder folder_;
  std::vector<std::string> options_;
  std::vector<std::unique_ptr<Process>> agents_;
};

}  // namespace bodeflow::test
