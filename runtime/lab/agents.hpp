#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "lab/clock.hpp"
#include "plugins/registry.hpp"
#include "transport/link.hpp"

namespace bodeflow::lab {

/// An agent as it shows itself to the lab.
struct AgentInfo {
  std::string name, version, system;
  std::uint32_t vector_level = 1;
  int processors = 1;
  double load = 0.0;
  std::vector<std::string> runs;                           ///< parts that it runs now
  std::vector<std::pair<std::string, std::string>> ended;  ///< parts that have ended lately, and how
  struct Plugin {
    std::string name, version, sha256;
  };
  std::vector<Plugin> plugins;
};

nlohmann::json to_json(const AgentInfo& agent);
/// Nothing where the text is none of ours.
std::optional<AgentInfo> agent_from(const std::string& text);

/// A name that no other run or request has, on any machine.
std::string new_name();

/// Watches who is in the lab.
class Lab {
 public:
  static tl::expected<std::unique_ptr<Lab>, std::string> watch(const std::shared_ptr<transport::Participant>& participant);
  /// The agents that are there, by name.
  std::vector<AgentInfo> agents() const;
  /// Waits until all of `names` are there. Error: who is missing and who is there.
  tl::expected<std::vector<AgentInfo>, std::string> wait_for(const std::vector<std::string>& names, double seconds,
                                                             const transport::GoOn& go_on) const;

 private:
  std::unique_ptr<transport::Board> board_;
};

/// What an agent is started with.
struct AgentTask {
  AgentInfo info;  ///< name, version, plugins ... of this machine
  transport::Settings settings;
  std::filesystem::path directory;               ///< runs are kept below it until they are fetched
  std::vector<std::string> command;              ///< of a part's process; its own options follow
  std::function<void(const std::string&)> tell;  ///< a line for people
  bool once = false;                             ///< ends with the first run
  /// Takes a new list of revoked certificates (PEM); true: it is a later one of the lab's authority.
  std::function<bool(const std::string& pem)> take_revocations;
};

/// Serves the lab until `stop`: starts a process for each part that a launcher asks for. True: it has got a new list of revoked
/// certificates, has ended its runs, and must join anew. Error: why it can't serve.
tl::expected<bool, std::string> serve_agent(const AgentTask& task, const std::atomic<bool>& stop);

/// Sends a list of revoked certificates (PEM) to all agents that are there; their names. Error: why not.
tl::expected<std::vector<std::string>, std::string> tell_revocations(const std::shared_ptr<transport::Participant>& participant,
                                                                     const std::string& pem, double seconds);

/// Asks an agent to start its part of a run. Error: why it does not.
tl::expected<void, std::string> ask_for_part(const std::shared_ptr<transport::Participant>& participant, const std::string& agent,
                                             const std::string& run, double seconds);

/// How far an agent's wall clock is from ours. Error: it does not answer.
tl::expected<ClockOffset, std::string> clock_of(const std::shared_ptr<transport::Participant>& participant,
                                                const std::string& agent, double seconds);

/// What launchers tell of their runs, for people: {"run", "graph", "phase", "hosts": [{"host", "time_s", "rate", "links"}]}.
inline constexpr const char* kRunsBoard = "bodeflow/runs";

/// The options of a part's process, behind the command.
std::vector<std::string> part_options(const std::string& run, const std::string& host, const std::filesystem::path& directory,
                                      const transport::Settings& settings);
nlohmann::json to_json(const transport::Settings& settings);
transport::Settings settings_from(const nlohmann::json& json);

}  // namespace bodeflow::lab
