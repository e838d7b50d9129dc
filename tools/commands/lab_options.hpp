#pragma once

#include "commands/command.hpp"
#include "lab/agents.hpp"

namespace bodeflow::tools {

/// How a command takes part in the lab: network, discovery, trust.
struct LabOptions {
  bool loopback = false;
  bool let_anyone_in = false;
  std::string trust;                    ///< folder; empty: the usual one
  std::vector<std::string> interfaces;  ///< IP addresses
  std::vector<std::string> peers;
  std::string server;
  std::string carrier = "automatic";
  std::uint32_t domain = 0;

  void add_to(CLI::App& app);
  /// Only what tells how to reach the others.
  void add_network_to(CLI::App& app);
  /// --trust, or the usual folder; may be empty.
  std::filesystem::path trust_folder() const;
  /// `host`: whose certificate this process uses; empty: the only one in the folder of trust. Error: also where the network would
  /// be open to strangers without the words that allow it.
  tl::expected<transport::Settings, std::string> settings(const std::string& host) const;
  /// Joins the lab to look around. Error: the exit code, why not was said.
  tl::expected<std::shared_ptr<transport::Participant>, ExitCode> join() const;
};

/// What `bodeflow agent` is told.
struct AgentCommand {
  LabOptions lab;
  std::string name;
  std::string directory;  ///< of runs; empty: the usual one
  double memory_gb = 0.0;
  bool once = false;  ///< one run, then it ends
};

/// Serves the lab as an agent; the exit code.
int serve_lab(const Session& session, const AgentCommand& command);

/// The command of a process that runs one host's part; its options follow.
std::vector<std::string> part_command(const Session& session);

/// This machine as an agent of that name: version, plugins, vector level.
lab::AgentInfo this_machine(const Session& session, const Registry& registry, const std::string& name);

}  // namespace bodeflow::tools
