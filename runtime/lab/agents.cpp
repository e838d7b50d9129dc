// The lab as a launcher or a person sees it: who is there, and what is asked of them.
#include "lab/agents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include "lab/agent_topics.hpp"

namespace bodeflow::lab {

using nlohmann::json;
namespace fs = std::filesystem;

json to_json(const AgentInfo& agent) {
  json plugins = json::array();
  for (const auto& plugin : agent.plugins)
    plugins.push_back({{"name", plugin.name}, {"version", plugin.version}, {"sha256", plugin.sha256}});
  json ended = json::array();
  for (const auto& [run, how] : agent.ended) ended.push_back({run, how});
  return {{"agent", agent.name},
          {"version", agent.version},
          {"system", agent.system},
          {"vector_level", agent.vector_level},
          {"processors", agent.processors},
          {"load", agent.load},
          {"runs", agent.runs},
          {"ended", ended},
          {"plugins", plugins}};
}

std::optional<AgentInfo> agent_from(const std::string& text) {
  try {
    const json item = json::parse(text);
    AgentInfo agent;
    agent.name = item.at("agent").get<std::string>();
    agent.version = item.at("version").get<std::string>();
    agent.system = item.at("system").get<std::string>();
    agent.vector_level = item.at("vector_level").get<std::uint32_t>();
    agent.processors = item.at("processors").get<int>();
    agent.load = item.at("load").get<double>();
    agent.runs = item.at("runs").get<std::vector<std::string>>();
    for (const json& one : item.value("ended", json::array()))
      agent.ended.emplace_back(one.at(0).get<std::string>(), one.at(1).get<std::string>());
    for (const json& plugin : item.at("plugins"))
      agent.plugins.push_back({plugin.at("name").get<std::string>(), plugin.at("version").get<std::string>(),
                               plugin.at("sha256").get<std::string>()});
    return agent;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

tl::expected<std::unique_ptr<Lab>, std::string> Lab::watch(const std::shared_ptr<transport::Participant>& participant) {
  auto board = transport::open_board(participant, kAgentsBoard, false);
  if (!board) return tl::unexpected(board.error().text);
  auto lab = std::make_unique<Lab>();
  lab->board_ = std::move(*board);
  return lab;
}

std::vector<AgentInfo> Lab::agents() const {
  std::vector<AgentInfo> agents;
  for (const std::string& text : board_->texts())
    if (auto agent = agent_from(text)) agents.push_back(std::move(*agent));
  std::sort(agents.begin(), agents.end(), [](const AgentInfo& a, const AgentInfo& b) { return a.name < b.name; });
  return agents;
}

tl::expected<std::vector<AgentInfo>, std::string> Lab::wait_for(const std::vector<std::string>& names, double seconds,
                                                                const transport::GoOn& go_on) const {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const std::vector<AgentInfo> there = agents();
    std::vector<AgentInfo> found;
    std::vector<std::string> missing, present;
    for (const AgentInfo& agent : there) present.push_back(agent.name);
    for (const std::string& name : names) {
      const auto count = std::count(present.begin(), present.end(), name);
      if (count > 1) return tl::unexpected(fmt::format("{} agents are called '{}': give each host its own name", count, name));
      const auto agent = std::find_if(there.begin(), there.end(), [&](const AgentInfo& a) { return a.name == name; });
      if (agent == there.end())
        missing.push_back(name);
      else
        found.push_back(*agent);
    }
    if (missing.empty()) return found;
    if (!go_on() || std::chrono::steady_clock::now() > until)
      return tl::unexpected(fmt::format(
          "no agent of {} {} is there; {}: start 'bodeflow agent --name {}' there", missing.size() == 1 ? "host" : "hosts",
          fmt::join(missing, ", "),
          present.empty() ? std::string("nobody is in the lab") : fmt::format("in the lab: {}", fmt::join(present, ", ")),
          missing.front()));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

std::string new_name() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

tl::expected<std::vector<std::string>, std::string> tell_revocations(const std::shared_ptr<transport::Participant>& participant,
                                                                     const std::string& pem, double seconds) {
  auto lab = Lab::watch(participant);
  if (!lab) return tl::unexpected(lab.error());
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  std::vector<std::string> told;
  std::string missed;
  for (const AgentInfo& agent : (*lab)->agents()) {
    const auto posted = transport::post(participant, mailbox_of(agent.name), json{{"revoked", pem}}.dump(), seconds);
    if (posted)
      told.push_back(agent.name);
    else
      missed += (missed.empty() ? "" : "; ") + posted.error().text;
  }
  if (!missed.empty()) return tl::unexpected("not all agents have the new list: " + missed);
  return told;
}

tl::expected<void, std::string> ask_for_part(const std::shared_ptr<transport::Participant>& participant, const std::string& agent,
                                             const std::string& run, double seconds) {
  auto posted = transport::post(participant, mailbox_of(agent), json{{"start", run}}.dump(), seconds);
  if (!posted) return tl::unexpected(posted.error().text);
  return {};
}

tl::expected<ClockOffset, std::string> clock_of(const std::shared_ptr<transport::Participant>& participant,
                                                const std::string& agent, double seconds) {
  const std::string name = new_name();
  auto posted = transport::post(participant, mailbox_of(agent), json{{"clock", name}}.dump(), seconds);
  if (!posted) return tl::unexpected(posted.error().text);
  return ask_clock(participant, clock_topic(name), seconds);
}

std::vector<std::string> part_options(const std::string& run, const std::string& host, const fs::path& directory,
                                      const transport::Settings& settings) {
  return {"--run",       run,
          "--host",      host.empty() ? "-" : host,
          "--directory", directory.string(),
          "--settings",  to_json(settings).dump()};
}

json to_json(const transport::Settings& s) {
  json made = {{"domain", s.domain},         {"discovery", static_cast<int>(s.discovery)},
               {"peers", s.peers},           {"carrier", static_cast<int>(s.carrier)},
               {"interfaces", s.interfaces}, {"datagram", s.datagram},
               {"lease_s", s.lease_s}};
  if (s.security)
    made["security"] = {{"authority", s.security->authority.string()},
                        {"certificate", s.security->certificate.string()},
                        {"key", s.security->key.string()},
                        {"governance", s.security->governance.string()},
                        {"permissions", s.security->permissions.string()},
                        {"revocations", s.security->revocations.string()}};
  return made;
}

transport::Settings settings_from(const json& item) {
  transport::Settings s;
  s.domain = item.at("domain").get<std::uint32_t>();
  s.discovery = static_cast<transport::Settings::Discovery>(item.at("discovery").get<int>());
  s.peers = item.at("peers").get<std::vector<std::string>>();
  s.carrier = static_cast<transport::Settings::Carrier>(item.at("carrier").get<int>());
  s.interfaces = item.at("interfaces").get<std::vector<std::string>>();
  s.datagram = item.at("datagram").get<std::uint32_t>();
  s.lease_s = item.at("lease_s").get<double>();
  if (item.contains("security")) {
    const json& files = item["security"];
    const auto path = [&](const char* name) { return fs::path(files.at(name).get<std::string>()); };
    s.security = transport::Security{path("authority"),  path("certificate"), path("key"),
                                     path("governance"), path("permissions"), path("revocations")};
  }
  return s;
}

}  // namespace bodeflow::lab
