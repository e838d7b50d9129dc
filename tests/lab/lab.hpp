#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "system/command.hpp"
#include "transport/processes.hpp"

namespace bodeflow::test {

using Clock = std::chrono::steady_clock;

void sleep_s(double seconds);
double since_s(Clock::time_point begin);

/// A file, whole; empty where there is none.
std::string text_of(const std::string& file);

/// A closed loop over three hosts at 100 Hz, with `run` between the braces of its settings.
std::string closed_loop(const std::string& run);
/// What the ends of its connections have sent or taken after `samples` of each signal: the motor's way of two samples never reads
/// the last two.
int loop_samples(const nlohmann::json& link, int samples);

/// The network options of commands on `Hosts`, with those of trust: none by default.
std::vector<std::string> network_options(const std::vector<std::string>& trust = {"--let-anyone-on-the-network-in"});

/// Whether a test can't run for want of `hosts`; says so.
bool skipped(const Hosts& hosts);

/// Agents in processes of their own and runs of graphs over them, in a lab that no other test shares.
class TestLab {
 public:
  /// The network options of every command: this machine alone.
  TestLab() : options_{"--loopback", "--domain", std::to_string(test_domain())} {}
  explicit TestLab(std::vector<std::string> options) : options_(std::move(options)) {}

  /// Starts an agent; `before` stands in front of the command (a namespace), `more` behind it; it ends after
  /// `most_s`. Returns when it is there.
  Process& agent(const std::string& name, const std::vector<std::string>& more = {}, const std::vector<std::string>& before = {},
                 int most_s = 60);
  std::vector<std::string> agent_command(const std::string& name, const std::vector<std::string>& more = {}) const;
  /// The command `bodeflow run GRAPH` in this lab, with its messages on standard output.
  std::vector<std::string> run(const std::string& graph, const std::string& out, const std::vector<std::string>& more = {}) const;
  /// The same in one process.
  std::vector<std::string> run_here(const std::string& graph, const std::string& out) const;

  /// Starts agents `bench` and `controller` on hosts 1 and 2; the launcher's host is 0.
  void agents_on(const Hosts& hosts);
  /// The process of `run` on host 0.
  std::vector<std::string> run_on(const Hosts& hosts, const std::string& graph, const std::string& out) const;

  const Folder& folder() const { return folder_; }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  nlohmann::json manifest(const std::string& out) const;
  /// Hashes of all streams and records that a run kept.
  nlohmann::json hashes(const std::string& out) const;
  /// The samples of a recorded stream.
  std::vector<double> stream(const std::string& file, const std::string& key) const;
  /// The links of all hosts as they were when their phases ended: "host" and what `top` shows of a link.
  std::vector<nlohmann::json> links(const std::string& out) const;
  /// Hashes of the graph in one process, not paced.
  nlohmann::json hashes_here(std::string text) const;
  /// Waits for the end of `run`, which is complete and has kept the same.
  void require_complete(Process& run, const std::string& out, const nlohmann::json& hashes) const;
  /// What `bodeflow top --json --once` says in this lab.
  nlohmann::json top() const;
  /// Folders of runs that an agent holds.
  std::vector<std::string> runs_of(const std::string& agent) const;
  /// Waits until an agent's part of a run knows its graph; false: not within ten seconds.
  bool has_graph(const std::string& agent) const;
  /// The folder of a host's part whose phase has begun: the first or one that goes on for a lost one. Fails after 20 s.
  std::string begun(const std::string& host, int epoch = 0) const;
  /// The process that runs a host's part, as soon as it is there; 0: none after ten seconds.
  int part_of(const std::string& host) const;
  /// Ends the process of an agent, and with it all that it runs, as a crash does.
  void crash(const std::string& agent) const;

 private:
  Folder folder_;
  std::vector<std::string> options_;
  std::vector<std::unique_ptr<Process>> agents_;
};

}  // namespace bodeflow::test
