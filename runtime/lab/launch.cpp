// The launcher of a run over hosts: phase by phase it asks, lays out, starts, watches and collects.
#include "lab/launch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <random>
#include <set>

#include "lab/collect.hpp"
#include "lab/facts_json.hpp"
#include "lab/host_part.hpp"
#include "lab/own_part.hpp"
#include "lab/split.hpp"
#include "phases/condition.hpp"
#include "plan/facts.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;
using phases::RunResult;
using Clock = std::chrono::steady_clock;
using Done = tl::expected<void, std::string>;

constexpr double kWaitForAgents_s = 5.0, kWaitForParts_s = 15.0, kWaitForStop_s = 15.0;
constexpr double kBeat_s = 0.5;
/// A connection that stands still for so long is shown.
constexpr double kShownStall_s = 0.7;

std::vector<std::string> hosts_of(const graph::Graph& graph) {
  std::vector<std::string> hosts;
  for (const graph::Phase& phase : graph.phases)
    for (const graph::Block& block : phase.blocks)
      if (std::find(hosts.begin(), hosts.end(), block.host) == hosts.end()) hosts.push_back(block.host);
  return hosts;
}

std::string new_run_name() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

/// What ends a run before its end.
struct Ended {
  RunResult::Status status = RunResult::Status::failed;
  std::string block, reason;
  Problems problems;
};

class Launch {
 public:
  Launch(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory, const LaunchOptions& options)
      : graph_(graph), registry_(registry), directory_(directory), options_(options), run_(new_run_name()) {}

  RunResult run() {
    RunResult result;
    if (auto ready = begin(); !ready) {
      result = failed("", ready.error());
      if (!stopped()) result.status = RunResult::Status::unreachable;
    } else {
      for (std::size_t i = 0; i < graph_.phases.size() && result.status == RunResult::Status::complete; ++i)
        result = run_phase_often(i);
    }
    finish(result);
    return result;
  }

 private:
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  /// The longest silence of a host that any phase bears.
  double tolerance_s() const {
    double most = 0.0;
    for (const graph::Phase& phase : graph_.phases) most = std::max(most, phase.run.tolerance_s);
    return most;
  }

  static RunResult failed(const std::string& phase, std::string reason) {
    return {RunResult::Status::failed, phase, "", std::move(reason), {}, false};
  }

  Done begin() {
    auto participant = transport::join(options_.settings);
    if (!participant) return tl::unexpected(participant.error());
    participant_ = *participant;
    std::vector<std::string> hosts = hosts_of(graph_);
    std::sort(hosts.begin(), hosts.end());  // our own part first: it starts while the agents are asked
    std::vector<std::string> others;
    for (const std::string& host : hosts)
      if (!host.empty()) others.push_back(host);
    auto lab = Lab::watch(participant_);
    if (!lab) return tl::unexpected(lab.error());
    static const std::atomic<bool> kGoOn{false};
    auto agents = (*lab)->wait_for(others, kWaitForAgents_s, options_.stop != nullptr ? *options_.stop : kGoOn);
    if (!agents) return tl::unexpected(agents.error());
    for (const AgentInfo& agent : *agents)
      if (auto fits = check(agent); !fits) return fits;
    for (const std::string& host : hosts)
      if (auto started = start(host); !started) return started;
    for (auto& part : parts_)
      if (auto connected = connect(*part); !connected) return connected;
    const json begin = {{"do", "begin"},
                        {"graph", graph_.expanded},
                        {"file", graph_.file},
                        {"name", std::filesystem::path(graph_.file).stem().string()},
                        {"manifest", {{"run", run_}}},
                        {"tolerance_s", tolerance_s()},
                        {"vector_level", options_.vector_level},
                        {"chunk", options_.plan.chunk.value_or(0)},
                        {"threads", options_.plan.threads.value_or(0)}};
    for (auto& part : parts_) {
      json mine = begin;
      mine["manifest"]["host"] = part->name();
      auto answer = ask(*part, mine);
      if (!answer) return tl::unexpected(answer.error().reason);
    }
    auto board = transport::open_board(participant_, kRunsBoard, true);
    if (!board) return tl::unexpected(board.error().text);
    board_ = std::move(*board);
    directory_.event("hosts", {{"run", run_}, {"hosts", hosts}});
    return {};
  }

  /// The same version, plugins and vector level as here.
  Done check(const AgentInfo& agent) const {
    const auto refuse = [&](const std::string& why) {
      return tl::unexpected(fmt::format("host '{}' does not fit this machine, nothing was started: {}", agent.name, why));
    };
    if (agent.version != options_.version)
      return refuse(fmt::format("bodeflow {} is there, {} here; install the same version", agent.version, options_.version));
    if (agent.vector_level < options_.vector_level)
      return refuse(fmt::format("its processor has vector level {}, the run uses {}; --isa chooses a lower one",
                                agent.vector_level, options_.vector_level));
    std::set<std::string> seen;
    for (const graph::Phase& phase : graph_.phases)
      for (const graph::Block& block : phase.blocks) {
        const PluginDescription* mine = block.host == agent.name ? registry_.plugin_of(block.type->id) : nullptr;
        if (mine == nullptr || !seen.insert(mine->name).second) continue;
        const auto theirs =
            std::find_if(agent.plugins.begin(), agent.plugins.end(), [&](const auto& p) { return p.name == mine->name; });
        if (theirs == agent.plugins.end()) return refuse(fmt::format("it has no plugin '{}'", mine->name));
        if (theirs->version != mine->version)
          return refuse(fmt::format("plugin '{}' is {} there, {} here", mine->name, theirs->version, mine->version));
        if (theirs->sha256 != mine->sha256)
          return refuse(fmt::format("plugin '{}' {} is another build there (SHA-256 {:.12} there, {:.12} here)", mine->name,
                                    mine->version, theirs->sha256, mine->sha256));
      }
    return {};
  }

  Done start(const std::string& host) {
    auto channel = Channel::open(participant_, run_, host, true);
    if (!channel) return tl::unexpected(channel.error());
    parts_.push_back(std::make_unique<HostPart>(host, std::move(*channel), tolerance_s(),
                                                [this](const auto& where, const auto& block, int level, const auto& text) {
                                                  directory_.log(where.empty() ? block : where + ": " + block, level, text);
                                                  if (options_.log) options_.log(where, block, level, text);
                                                }));
    parts_.back()->collect_into(directory_.path() / "hosts" / (host.empty() ? "launcher" : host));
    if (!host.empty()) return ask_for_part(participant_, host, run_, kWaitForAgents_s);
    return own_.start(options_.part_command, part_options(run_, "", directory_.path() / "own_part", options_.settings));
  }

  Done connect(HostPart& part) {
    const auto until = Clock::now() + std::chrono::duration<double>(kWaitForParts_s);
    auto connected =
        part.channel().connect([&] { return !stopped() && Clock::now() < until && (!part.name().empty() || own_.runs()); });
    if (!connected) return tl::unexpected(fmt::format("{} did not start its part: {}", part.title(), connected.error()));
    return {};
  }

  /// Twice a second each host hears that the launcher is there.
  Done beat() {
    if (std::chrono::duration<double>(Clock::now() - beaten_).count() < kBeat_s) return {};
    beaten_ = Clock::now();
    for (auto& part : parts_)
      if (gone_.count(part.get()) == 0)
        if (auto said = part->say({{"do", "beat"}}); !said) return said;
    return {};
  }

  /// The answer of a host. Error: it is lost, or what it refuses.
  tl::expected<json, Ended> ask(HostPart& part, const json& question) {
    if (auto said = part.say(question); !said) return tl::unexpected(Ended{RunResult::Status::failed, "", said.error(), {}});
    return wait_for_answer(part);
  }

  tl::expected<json, Ended> wait_for_answer(HostPart& part) {
    while (true) {
      if (stopped()) return tl::unexpected(Ended{RunResult::Status::interrupted, "", "interrupted", {}});
      Done fine = part.hear(0.02);
      if (fine) fine = beat();
      if (!fine) return tl::unexpected(Ended{RunResult::Status::failed, "", fine.error(), {}});
      auto answer = part.take_answer();
      if (!answer) continue;
      if (answer->contains("problems")) {
        Problems problems = problems_from((*answer)["problems"]);
        return tl::unexpected(Ended{RunResult::Status::rejected, "", to_string(problems), problems});
      }
      if (answer->contains("error"))
        return tl::unexpected(
            Ended{RunResult::Status::failed, "", fmt::format("{}: {}", part.title(), (*answer)["error"].get<std::string>()), {}});
      return *answer;
    }
  }

  /// Asks all hosts, then waits for all answers.
  tl::expected<void, Ended> ask_all(const json& question) {
    for (auto& part : parts_)
      if (auto said = part->say(question); !said) return tl::unexpected(Ended{RunResult::Status::failed, "", said.error(), {}});
    for (auto& part : parts_)
      if (auto answer = wait_for_answer(*part); !answer) return tl::unexpected(answer.error());
    return {};
  }

  HostPart& part_on(const std::string& host) {
    return **std::find_if(parts_.begin(), parts_.end(), [&](const auto& part) { return part->name() == host; });
  }

  tl::expected<plan::Facts, Ended> facts_of(const graph::Phase& phase) {
    std::optional<Ended> ended;
    const plan::Resolver resolver = [&](int index,
                                        const std::vector<StreamFacts>& inputs) -> tl::expected<Resolution, std::string> {
      const graph::Block& block = phase.blocks[static_cast<std::size_t>(index)];
      if (ended) return tl::unexpected(ended->reason);
      HostPart& part = part_on(block.host);
      if (auto said = part.say({{"do", "resolve"}, {"block", block.name}, {"inputs", to_json(inputs)}}); !said) {
        ended = Ended{RunResult::Status::failed, "", said.error(), {}};
        return tl::unexpected(said.error());
      }
      auto answer = wait_for_answer(part);
      if (!answer) {
        if (answer.error().status != RunResult::Status::failed || part.name().empty()) ended = answer.error();
        return tl::unexpected(answer.error().reason);
      }
      return resolution_from((*answer)["resolution"]);
    };
    auto facts = plan::establish_facts(phase, resolver);
    if (ended && ended->status == RunResult::Status::interrupted) return tl::unexpected(*ended);
    if (!facts) return tl::unexpected(Ended{RunResult::Status::rejected, "", to_string(facts.error()), facts.error()});
    return std::move(*facts);
  }

  RunResult run_phase_often(std::size_t index) {
    const graph::Phase& phase = graph_.phases[index];
    const auto holds = [&](const std::optional<graph::Condition>& condition) -> tl::expected<bool, Problem> {
      if (!condition) return true;
      return phases::holds(*condition, directory_.last_record(condition->phase, condition->block, condition->port));
    };
    const auto wanted = holds(phase.when);
    if (!wanted) return rejection(phase, {wanted.error()});
    if (!*wanted) {
      directory_.event("phase skipped", {{"phase", phase.name}});
      return {};
    }
    if (!phase.sweep.empty())
      return rejection(phase, {{phase.place, "a sweep runs on one machine: take 'hosts' away, or run it with --here"}});
    for (int repeat = 0; repeat < phase.repeat_max; ++repeat) {
      const auto ended = run_phase(index, repeat);
      if (!ended)
        return {ended.error().status, phase.name, ended.error().block, ended.error().reason, ended.error().problems, false};
      if (!phase.until) continue;
      const auto enough = holds(phase.until);
      if (!enough) return rejection(phase, {enough.error()});
      if (*enough) break;
    }
    return {};
  }

  static RunResult rejection(const graph::Phase& phase, Problems problems) {
    return {RunResult::Status::rejected, phase.name, "", to_string(problems), std::move(problems), false};
  }

  tl::expected<void, Ended> run_phase(std::size_t index, int repeat) {
    const graph::Phase& phase = graph_.phases[index];
    const auto initial = phases::initial_records(phase, directory_);
    if (!initial) return tl::unexpected(Ended{RunResult::Status::rejected, "", to_string(initial.error()), initial.error()});
    if (auto made = ask_all({{"do", "phase"}, {"phase", index}, {"repeat", repeat}}); !made) return made;
    auto facts = facts_of(phase);
    if (!facts) return tl::unexpected(facts.error());
    for (const std::string& warning : facts->warnings) options_.log("", "graph", BF_LOG_WARNING, warning);
    if (auto prepared = ask_all({{"do", "prepare"}, {"facts", to_json(*facts)}}); !prepared) return prepared;
    if (auto connected = ask_all({{"do", "connect"}}); !connected) return connected;
    directory_.event("phase begins", {{"phase", phase.name}, {"repeat", repeat}});
    if (auto started = start_phase(phase, repeat, *initial); !started)
      return tl::unexpected(Ended{RunResult::Status::failed, "", started.error(), {}});
    auto ended = watch(phase);
    keep_results(phase);
    return ended;
  }

  Done start_phase(const graph::Phase& phase, int repeat, const std::vector<execute::InitialRecord>& initial) {
    json list = json::array();
    for (const execute::InitialRecord& record : initial) list.push_back({record.to.block, record.to.port});
    for (auto& part : parts_) {
      part->forget_end();
      for (const execute::InitialRecord& record : initial)
        if (auto sent = part->send({reinterpret_cast<const std::byte*>(record.record.bytes()), record.record.size()}); !sent)
          return sent;
    }
    const json run = {{"do", "run"}, {"initial", list}, {"seed", phases::seed_of(phase, repeat)}};
    for (auto& part : parts_)
      if (auto said = part->say(run); !said) return said;
    return {};
  }

  /// Until all hosts have ended the phase; the first failure stops the others.
  tl::expected<void, Ended> watch(const graph::Phase& phase) {
    std::optional<Ended> why;
    Clock::time_point stopping;
    const auto end_all = [&](Ended ended) {
      if (why) return;
      why = std::move(ended);
      stopping = Clock::now();
      for (auto& part : parts_)
        if (!part->has_ended() && gone_.count(part.get()) == 0) (void)part->say({{"do", "stop"}});
    };
    while (true) {
      if (stopped()) end_all({RunResult::Status::interrupted, "", "interrupted", {}});
      bool all = true;
      for (auto& part : parts_) {
        if (gone_.count(part.get()) > 0 || part->has_ended()) continue;
        if (auto heard = part->hear(0.02); !heard) {
          gone_.insert(part.get());
          end_all({RunResult::Status::failed, "", heard.error(), {}});
        } else if (part->has_ended() && !part->ended().value("complete", false)) {
          end_all(end_of(*part));
        }
        all = all && (gone_.count(part.get()) > 0 || part->has_ended());
      }
      if (all) break;
      if (auto beaten = beat(); !beaten) end_all({RunResult::Status::failed, "", beaten.error(), {}});
      if (why && std::chrono::duration<double>(Clock::now() - stopping).count() > kWaitForStop_s) break;
      show(phase);
    }
    if (why) return tl::unexpected(*why);
    return {};
  }

  Ended end_of(const HostPart& part) const {
    Ended ended;
    const json& said = part.ended();
    if (said.value("interrupted", false)) ended.status = RunResult::Status::interrupted;
    ended.block = said.value("block", "");
    ended.reason = part.name().empty() ? said.value("reason", "") : fmt::format("{}: {}", part.title(), said.value("reason", ""));
    return ended;
  }

  /// Progress of the slowest host, and connections that stand still.
  void show(const graph::Phase& phase) {
    execute::Progress slowest;
    bool any = false;
    for (const auto& part : parts_) {
      const json& state = part->state();
      if (!state.is_object()) continue;
      const double time = state.value("time_s", 0.0);
      if (!any || time < slowest.time_s) slowest = {time, state.value("total_s", 0.0), state.value("rate", 0.0)};
      any = true;
      for (const json& link : state.value("links", json::array())) show_stall(*part, link);
    }
    if (any && options_.progress) options_.progress(phase.name, slowest);
    show_on_board(phase);
  }

  void show_on_board(const graph::Phase& phase) {
    if (std::chrono::duration<double>(Clock::now() - shown_).count() < kBeat_s) return;
    shown_ = Clock::now();
    json hosts = json::array();
    for (const auto& part : parts_) {
      const json& state = part->state();
      if (state.is_object())
        hosts.push_back({{"host", part->name()},
                         {"time_s", state.value("time_s", 0.0)},
                         {"rate", state.value("rate", 0.0)},
                         {"links", state.value("links", json::array())}});
    }
    (void)board_->say(json{{"run", run_}, {"graph", graph_.file}, {"phase", phase.name}, {"hosts", hosts}}.dump());
  }

  void show_stall(const HostPart& part, const json& link) {
    const std::string key = part.name() + "/" + link.value("connection", "");
    const double still = link.value("stalled_s", 0.0);
    if (still < kShownStall_s) {
      if (stalled_.erase(key) > 0) options_.log(part.name(), link.value("connection", ""), BF_LOG_INFO, "goes on");
      return;
    }
    if (!stalled_.insert(key).second) return;
    const std::string text =
        fmt::format("stands still since {:.1f} s: {} {}", still, link.value("sends", false) ? "no room at" : "nothing from",
                    link.value("other", "").empty() ? std::string("this machine") : link.value("other", ""));
    directory_.event("connection stalled",
                     {{"host", part.name()}, {"connection", link.value("connection", "")}, {"seconds", still}});
    options_.log(part.name(), link.value("connection", ""), BF_LOG_WARNING, text);
  }

  void keep_results(const graph::Phase& phase) {
    for (const auto& part : parts_) {
      if (!part->has_ended()) continue;
      directory_.event("host ends", {{"phase", phase.name}, {"host", part->name()}, {"end", part->ended()}});
      const json& names = part->ended()["records"];
      for (std::size_t i = 0; i < names.size(); ++i)
        directory_.set_result(phase.name, names[i][0].get<std::string>(), names[i][1].get<std::string>(), part->records()[i]);
    }
  }

  /// Brings the hosts' files here; then every host may go.
  void finish(RunResult& result) {
    for (auto& part : parts_) {
      if (gone_.count(part.get()) > 0) continue;
      if (auto collected = collect(*part, result); !collected) {
        if (result.status == RunResult::Status::complete) result = failed(result.phase, collected.error());
        options_.log(part->name(), "collection", BF_LOG_ERROR, collected.error());
      }
      gone_.insert(part.get());
      (void)part->say({{"do", "bye"}});
      part->channel().drain(1.0);
    }
    if (auto merged = merge_hosts(directory_); !merged && result.status == RunResult::Status::complete)
      result = failed(result.phase, merged.error());
    own_.end();
  }

  Done collect(HostPart& part, const RunResult& result) {
    if (auto said = part.say({{"do", "close"}, {"status", phases::status_word(result.status)}, {"reason", result.reason}}); !said)
      return said;
    while (!part.collected()) {
      if (auto heard = part.hear(0.1); !heard) return heard;
      if (auto beaten = beat(); !beaten) return beaten;
    }
    if (!part.close_error().empty()) return tl::unexpected(fmt::format("{}: {}", part.title(), part.close_error()));
    return {};
  }

  const graph::Graph& graph_;
  const Registry& registry_;
  record::RunDirectory& directory_;
  const LaunchOptions& options_;
  std::string run_;
  std::shared_ptr<transport::Participant> participant_;
  OwnPart own_;
  std::vector<std::unique_ptr<HostPart>> parts_;
  std::set<const HostPart*> gone_;  ///< lost, or dismissed
  std::set<std::string> stalled_;
  std::unique_ptr<transport::Board> board_;
  Clock::time_point beaten_, shown_;
};

}  // namespace

RunResult launch(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory,
                 const LaunchOptions& options) {
  return Launch(graph, registry, directory, options).run();
}

bool has_hosts(const graph::Graph& graph) {
  const std::vector<std::string> hosts = hosts_of(graph);
  return hosts.size() > 1 || (hosts.size() == 1 && !hosts.front().empty());
}

}  // namespace bodeflow::lab
