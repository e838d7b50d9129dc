#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "commands/lab_options.hpp"
#include "commands/vector_level.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {
namespace {

struct HostsCommand {
  LabOptions lab;
  bool json = false;
  double wait_s = 2.0;
};

struct Host {
  lab::AgentInfo agent;
  tl::expected<lab::ClockOffset, std::string> clock;
  std::string differs;  ///< what is not as on this machine
};

std::string difference(const lab::AgentInfo& theirs, const lab::AgentInfo& mine) {
  if (theirs.version != mine.version) return fmt::format("bodeflow {} here", mine.version);
  std::string names;
  for (const auto& plugin : mine.plugins)
    for (const auto& other : theirs.plugins)
      if (other.name == plugin.name && other.sha256 != plugin.sha256) names += (names.empty() ? "" : ", ") + plugin.name;
  return names.empty() ? "" : "other builds of " + names;
}

void print_table(const std::vector<Host>& hosts) {
  std::size_t name = std::string_view("host").size(), machine = std::string_view("machine").size();
  for (const Host& host : hosts) {
    name = std::max(name, host.agent.name.size());
    machine = std::max(machine, host.agent.system.size());
  }
  fmt::print("{} {:<{}} {:<8} {:>7} {:>5} {:>5} {:<10} {:>22} {}\n", bold(fmt::format("{:<{}}", "host", name)), "machine",
             machine, "version", "plugins", "cores", "load", "vector", "clock - ours", "runs");
  for (const Host& host : hosts) {
    const std::string clock =
        host.clock ? fmt::format("{:+.3f} +- {:.3f} ms", host.clock->offset_s * 1e3, host.clock->uncertainty_s * 1e3)
                   : std::string("no answer");
    fmt::print("{:<{}} {:<{}} {:<8} {:>7} {:>5} {:>5.1f} {:<10} {:>22} {}\n", host.agent.name, name, host.agent.system, machine,
               host.agent.version, host.agent.plugins.size(), host.agent.processors, host.agent.load,
               vector_level_name(host.agent.vector_level), clock,
               host.agent.runs.empty() ? "-" : fmt::format("{}", fmt::join(host.agent.runs, ", ")));
    if (!host.differs.empty()) fmt::print("{:<{}} {}\n", "", name, host.differs);
  }
}

nlohmann::ordered_json to_json(const std::vector<Host>& hosts) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Host& host : hosts) {
    nlohmann::ordered_json item = lab::to_json(host.agent);
    item["clock_offset_s"] = host.clock ? nlohmann::ordered_json(host.clock->offset_s) : nullptr;
    item["clock_uncertainty_s"] = host.clock ? nlohmann::ordered_json(host.clock->uncertainty_s) : nullptr;
    item["differs"] = host.differs;
    list.push_back(std::move(item));
  }
  return list;
}

int hosts(const Session& session, const HostsCommand& command) {
  const auto participant = command.lab.join();
  if (!participant) return participant.error();
  const auto lab = lab::Lab::watch(*participant);
  if (!lab) {
    say_error(lab.error());
    return kDevice;
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(command.wait_s));
  const Registry registry = session.open_registry();
  const lab::AgentInfo mine = this_machine(session, registry, "");
  std::vector<Host> found;
  for (const lab::AgentInfo& agent : (*lab)->agents())
    found.push_back({agent, lab::clock_of(*participant, agent.name, 3.0), difference(agent, mine)});
  if (command.json)
    print_json(to_json(found));
  else if (found.empty())
    fmt::print("Nobody is in the lab: start 'bodeflow agent --name NAME' on its machines.\n");
  else
    print_table(found);
  return kDone;
}

}  // namespace

void add_hosts(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("hosts", "Show the machines of the lab: versions, plugins, load, clocks");
  auto options = std::make_shared<HostsCommand>();
  command->add_flag("--json", options->json, "As JSON");
  command->add_option("--wait", options->wait_s, "Seconds to look around")->check(CLI::Range(0.1, 60.0));
  options->lab.add_to(*command);
  command->callback([&session, options] { session.action = [&session, options] { return hosts(session, *options); }; });
}

}  // namespace bodeflow::tools
