// One machine's agent: starts a process for each part that a launcher asks for, and tells the lab what it runs.
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <deque>
#include <future>
#include <map>
#include <thread>

#include "graph/node.hpp"
#include "lab/agent_topics.hpp"
#include "lab/agents.hpp"
#include "lab/part_process.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int kLooks = 20;  ///< of 50 ms
constexpr auto kReceipt = std::chrono::milliseconds(500);
constexpr double kClock_s = 3.0;
constexpr std::size_t kMostClocks = 8;
constexpr std::size_t kKeptEnds = 32;  ///< of parts: launchers look within seconds

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
    auto board = transport::open_board(*participant, kAgentsBoard, true);
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
    info.ended.assign(ended_.begin(), ended_.end());
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
      ended_.emplace_back(child->second, how_it_ended(status));
      if (ended_.size() > kKeptEnds) ended_.pop_front();
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
  std::deque<std::pair<std::string, std::string>> ended_;  ///< runs and how, the newest last
  std::shared_ptr<transport::Participant> participant_;
  std::vector<std::future<void>> clocks_;
  std::string said_;
  int served_ = 0;
  bool renewed_ = false;  ///< the list of revoked certificates
};

}  // namespace

tl::expected<bool, std::string> serve_agent(const AgentTask& task, const std::atomic<bool>& stop) {
  return Agent(task, stop).serve();
}

}  // namespace bodeflow::lab
