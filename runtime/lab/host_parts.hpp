#pragma once

#include <future>
#include <set>

#include "lab/host_part.hpp"
#include "lab/launch.hpp"
#include "lab/own_part.hpp"

namespace bodeflow::lab {

/// What ends a run before its end.
struct Ended {
  phases::RunResult::Status status = phases::RunResult::Status::failed;
  std::string block, reason;
  Problems problems;
};

/// The parts of a run, one process on each of its hosts: found, started, asked together, and dismissed.
class HostParts {
 public:
  HostParts(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory, const LaunchOptions& options);

  /// Waits for the agents, starts the parts and gives them the graph. Error: who is not there or does not fit; nothing was
  /// started where one does not fit.
  tl::expected<void, std::string> begin();

  /// The name that the run has in the lab.
  const std::string& run() const { return run_; }
  const std::shared_ptr<transport::Participant>& participant() const { return participant_; }
  /// The user wants the run to end.
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  const std::vector<std::unique_ptr<HostPart>>& all() const { return parts_; }
  HostPart& on(const std::string& host) const;
  /// Lost, or dismissed: it is told nothing any more.
  bool is_gone(const HostPart& part) const { return gone_.count(&part) > 0; }
  void lose(const HostPart& part) { gone_.insert(&part); }

  /// Why the part's process has gone, as its host's agent tells; nothing: it has not, or nobody knows.
  std::optional<std::string> why_gone(const HostPart& part);
  /// The first part, neither lost nor at the end of its phase, whose process has gone, and why.
  std::optional<std::pair<HostPart*, std::string>> find_gone();

  /// Starts other processes in place of the parts of these hosts, and gives them the graph. Error: one can't be had.
  tl::expected<void, Ended> start_again(const std::set<std::string>& hosts);
  /// Of the part that a host has now: how often parts of the run had been started again before it was.
  int epoch(const std::string& host) const {
    const auto found = epochs_.find(host);
    return found == epochs_.end() ? 0 : found->second;
  }

  /// The answer of a host. Error: it or another one is lost, or what it refuses.
  tl::expected<nlohmann::json, Ended> ask(HostPart& part, const nlohmann::json& question);
  /// The answer to what was said to it last.
  tl::expected<nlohmann::json, Ended> wait_for_answer(HostPart& part);
  /// Asks all hosts, then waits for all answers.
  tl::expected<void, Ended> ask_all(const nlohmann::json& question);
  tl::expected<void, std::string> tell_all(const nlohmann::json& message);
  /// Says twice a second that the launcher is there.
  tl::expected<void, std::string> beat();

  /// Brings the hosts' files into the run directory and lets every host go; a complete run of which something can't be had has
  /// failed.
  void finish(phases::RunResult& result);

 private:
  tl::expected<void, std::string> check(const AgentInfo& agent) const;
  tl::expected<void, std::string> start(const std::string& host);
  tl::expected<void, std::string> connect(HostPart& part);
  tl::expected<std::unique_ptr<HostPart>, std::string> open(const std::string& host);
  tl::expected<void, Ended> greet(HostPart& part);
  tl::expected<void, std::string> replace(HostPart& part);
  tl::expected<void, std::string> collect(HostPart& part, const phases::RunResult& result);

  const graph::Graph& graph_;
  const Registry& registry_;
  record::RunDirectory& directory_;
  const LaunchOptions& options_;
  const std::string run_ = new_name();
  double tolerance_s_ = 0.0;  ///< the longest silence of a host that any phase bears
  std::shared_ptr<transport::Participant> participant_;
  std::unique_ptr<Lab> lab_;
  OwnPart own_;
  std::vector<std::unique_ptr<HostPart>> parts_, lost_;
  std::map<std::string, int> epochs_;  ///< by host
  int epoch_ = 0;                      ///< the last one of the run
  std::vector<std::future<void>> requests_;
  std::set<const HostPart*> gone_;
  std::chrono::steady_clock::time_point beaten_;
};

/// The hosts of a graph, sorted; this machine is "".
std::vector<std::string> hosts_of(const graph::Graph& graph);

}  // namespace bodeflow::lab
