#include "lab/agents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <map>
#include <random>
#include <thread>

#include "graph/node.hpp"
#include "lab/part_process.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const std::string kBoard = "bodeflow/agents";

std::string mailbox_of(const std::string& agent) { return "bodeflow/agent/" + agent; }

constexpr int kLooks = 20;  ///< of 50 ms
constexpr auto kReceipt = std::chrono::milliseconds(500);
constexpr double kClock_s = 3.0;
constexpr std::size_t kMostClocks = 8;

std::string clock_topic(const std::string& name) { return "bodeflow/clock/" + name; }

/// Names of runs and hosts go into topics and folder names.
bool is_plain(const std::string& name) { return name.size() <= 64 && graph::is_name(name); }

double load_now() {
  double load = 0.0;
  return getloadavg(&load, 1) == 1 ? load : 0.0;
}

class Agent {
 public:
  Agent(const AgentTask& task, const std::atomic<bool>& stop) : task_(task), stop_(stop) {}

  tl::expected<bool, std::string> serve() {
    auto participant = transport::join(task_.settings);
    if (!participant) return tl::unexpected(participant.error());
    participant_ = *participant;
    auto mailbox = transport::open_mailbox(*participant, mailbox_of(task_.info.name));
    if (!mailbox) return tl::unexpected(mailbox.error().text);
    auto board = transport::open_board(*participant, kBoard, true);
    if (!board) return tl::unexpected(board.error().text);
    if (is_taken(**board)) return tl::unexpected(fmt::format("the lab has an agent called '{}' already", task_.info.name));
    task_.tell(fmt::format("agent '{}' is there: {} plugins, runs below '{}'", task_.info.name, task_.info.plugins.size(),
                           task_.directory.string()));
    while (!stop_ && !renewed_ && !(task_.once && served_ > 0 && children_.empty())) {
      if (auto said = say_hello(**board); !said) return tl::unexpected(said.error());
      if (const auto text = (*mailbox)->receive(0.2)) take(*text);
      reap();
    }
    end_children();
    return renewed_;
  }

 private:
  /// Whether another agent of this name shows itself while we look around.
  bool is_taken(transport::Board& board) const {
    for (int i = 0; i < kLooks && !stop_; ++i) {
      for (const std::string& text : board.texts())
        if (const auto agent = agent_from(text); agent && agent->name == task_.info.name) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }

  tl::expected<void, std::string> say_hello(transport::Board& board) {
    AgentInfo info = task_.info;
    info.load = std::round(load_now() * 10.0) / 10.0;
    for (const auto& [pid, run] : children_) info.runs.push_back(run);
    std::string text = to_json(info).dump();
    if (text == said_) return {};
    auto said = board.say(text);
    if (!said) return tl::unexpected(said.error().text);
    said_ = std::move(text);
    return {};
  }

  void take(const std::string& text) {
    const json wish = json::parse(text, nullptr, false);
    const auto said = [&](const char* key) {
      return wish.is_object() && wish.contains(key) && wish[key].is_string() ? wish[key].get<std::string>() : std::string();
    };
    if (const std::string clock = said("clock"); is_plain(clock)) return tell_time(clock);
    if (const std::string list = said("revoked"); !list.empty()) return renew(list);
    if (const std::string run = said("start"); is_plain(run)) return begin(run);
    task_.tell("a message that is no request was dropped");
  }

  void renew(const std::string& revocations) {
    renewed_ = task_.take_revocations && task_.take_revocations(revocations);
    if (renewed_) std::this_thread::sleep_for(kReceipt);  // the sender still waits for our receipt
  }

  void begin(const std::string& run) {
    const fs::path directory = task_.directory / run;
    std::error_code error;
    fs::create_directories(task_.directory, error);
    if (error) return task_.tell(fmt::format("run '{}': can't create '{}': {}", run, task_.directory.string(), error.message()));
    const auto pid = start_part(task_.command, part_options(run, task_.info.name, directory, task_.settings));
    if (!pid) return task_.tell(fmt::format("run '{}': {}", run, pid.error()));
    children_[*pid] = run;
    ++served_;
    task_.tell(fmt::format("run '{}' begins", run));
  }

  void tell_time(const std::string& name) {
    std::erase_if(
        clocks_, [](std::future<void>& answer) { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
    if (clocks_.size() < kMostClocks)
      clocks_.push_back(std::async(std::launch::async, answer_clock, participant_, clock_topic(name), kClock_s));
  }

  void reap() {
    int status = 0;
    for (pid_t pid = 0; (pid = waitpid(-1, &status, WNOHANG)) > 0;) {
      const auto child = children_.find(pid);
      if (child == children_.end()) continue;
      task_.tell(WIFSIGNALED(status) ? fmt::format("run '{}': ended by signal {}", child->second, WTERMSIG(status))
                                     : fmt::format("run '{}' ends with exit code {}", child->second, WEXITSTATUS(status)));
      children_.erase(child);
    }
  }

  void end_children() {
    for (const auto& [pid, run] : children_) kill(pid, SIGTERM);
    for (int i = 0; i < 50 && !children_.empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      reap();
    }
    for (const auto& [pid, run] : children_) kill(pid, SIGKILL);
  }

  const AgentTask& task_;
  const std::atomic<bool>& stop_;
  std::map<pid_t, std::string> children_;
  std::shared_ptr<transport::Participant> participant_;
  std::vector<std::future<void>> clocks_;
  std::string said_;
  int served_ = 0;
  bool renewed_ = false;  ///< the list of revoked certificates
};

}  // namespace

json to_json(const AgentInfo& agent) {
  json plugins = json::array();
  for (const auto& plugin : agent.plugins)
    plugins.push_back({{"name", plugin.name}, {"version", plugin.version}, {"sha256", plugin.sha256}});
  return {{"agent", agent.name},
          {"version", agent.version},
          {"system", agent.system},
          {"vector_level", agent.vector_level},
          {"processors", agent.processors},
          {"load", agent.load},
          {"runs", agent.runs},
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
    for (const json& plugin : item.at("plugins"))
      agent.plugins.push_back({plugin.at("name").get<std::string>(), plugin.at("version").get<std::string>(),
                               plugin.at("sha256").get<std::string>()});
    return agent;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

tl::expected<std::unique_ptr<Lab>, std::string> Lab::watch(const std::shared_ptr<transport::Participant>& participant) {
  auto board = transport::open_board(participant, kBoard, false);
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

tl::expected<bool, std::string> serve_agent(const AgentTask& task, const std::atomic<bool>& stop) {
  return Agent(task, stop).serve();
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
