// The launcher of a run over hosts: phase by phase it asks, lays out, starts, watches and keeps what they found.
#include "lab/launch.hpp"

#include <fmt/format.h>

#include "lab/facts_json.hpp"
#include "lab/restart.hpp"
#include "lab/split.hpp"
#include "plan/facts.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;
using phases::RunResult;
using Clock = std::chrono::steady_clock;
using Done = tl::expected<void, std::string>;

constexpr double kWaitForStop_s = 15.0;
constexpr double kShow_s = 0.5;
/// A connection that stands still for so long is shown.
constexpr double kShownStall_s = 0.7;

class Launch {
 public:
  Launch(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory, const LaunchOptions& options)
      : graph_(graph), directory_(directory), options_(options), hosts_(graph, registry, directory, options) {}

  RunResult run() {
    RunResult result;
    if (auto ready = begin(); !ready) {
      const auto status = hosts_.stopped() ? RunResult::Status::failed : RunResult::Status::unreachable;
      result = {status, "", "", ready.error(), {}, false};
    } else {
      result = phases::run_in_order(
          graph_, directory_, [this](std::size_t index, int repeat) { return run_phase(index, repeat); },
          [this](const graph::Phase& phase, const std::string& text) { warn("phase " + phase.name, text); });
    }
    hosts_.finish(result);
    return result;
  }

 private:
  Done begin() {
    if (auto ready = hosts_.begin(); !ready) return ready;
    auto board = transport::open_board(hosts_.participant(), kRunsBoard, true);
    if (!board) return tl::unexpected(board.error().text);
    board_ = std::move(*board);
    return {};
  }

  void warn(const std::string& who, const std::string& text) {
    directory_.log(who, BF_LOG_WARNING, text);
    if (options_.log) options_.log("", who, BF_LOG_WARNING, text);
  }

  RunResult run_phase(std::size_t index, int repeat) {
    const graph::Phase& phase = graph_.phases[index];
    if (!phase.sweep.empty())
      return phases::rejection(phase, {{phase.place, "a sweep runs on one machine: take 'hosts' away, or run it with --here"}});
    const auto initial = phases::initial_records(phase, directory_);
    if (!initial) return phases::rejection(phase, initial.error());
    auto ended = prepare(index, repeat);
    if (ended) ended = execute({phase, index, repeat, facts_, *initial, {}});
    if (ended) return {};
    Ended& why = ended.error();
    return {why.status, phase.name, std::move(why.block), std::move(why.reason), std::move(why.problems), false};
  }

  /// All hosts make their blocks of the phase, plan them, and connect to each other.
  tl::expected<void, Ended> prepare(std::size_t index, int repeat) {
    if (auto made = hosts_.ask_all({{"do", "phase"}, {"phase", index}, {"repeat", repeat}}); !made) return made;
    const auto facts = facts_of(graph_.phases[index]);
    if (!facts) return tl::unexpected(facts.error());
    facts_ = *facts;
    for (const std::string& warning : facts->warnings) warn("graph", warning);
    if (auto prepared = hosts_.ask_all({{"do", "prepare"}, {"facts", to_json(*facts)}}); !prepared) return prepared;
    return hosts_.ask_all({{"do", "connect"}, {"links", hosts_.run()}, {"epoch", 0}});
  }

  tl::expected<plan::Facts, Ended> facts_of(const graph::Phase& phase) {
    std::optional<Ended> ended;
    const plan::Resolver resolver = [&](int index,
                                        const std::vector<StreamFacts>& inputs) -> tl::expected<Resolution, std::string> {
      const graph::Block& block = phase.blocks[static_cast<std::size_t>(index)];
      if (ended) return tl::unexpected(ended->reason);
      auto answer = hosts_.ask(hosts_.on(block.host), {{"do", "resolve"}, {"block", block.name}, {"inputs", to_json(inputs)}});
      if (!answer) {
        ended = answer.error();
        return tl::unexpected(ended->reason);
      }
      if (answer->contains("refused")) return tl::unexpected((*answer)["refused"].get<std::string>());
      return resolution_from((*answer)["resolution"]);
    };
    auto facts = plan::establish_facts(phase, resolver);
    if (ended) return tl::unexpected(*ended);
    if (!facts) return tl::unexpected(Ended{RunResult::Status::rejected, "", to_string(facts.error()), facts.error()});
    return std::move(*facts);
  }

  tl::expected<void, Ended> execute(RunningPhase running) {
    directory_.event("phase begins", {{"phase", running.phase.name}, {"repeat", running.repeat}});
    for (auto& part : hosts_.all()) {
      part->forget_end();
      if (auto begun = begin_phase(*part, running.initial, phases::seed_of(running.phase, running.repeat)); !begun)
        return tl::unexpected(Ended{RunResult::Status::failed, "", begun.error(), {}});
    }
    running.started = Clock::now();
    auto ended = watch(running);
    keep_results(running.phase, running.repeat);
    return ended;
  }

  /// Until all hosts have ended the phase; the first failure stops the others.
  tl::expected<void, Ended> watch(const RunningPhase& running) {
    std::optional<Ended> why;
    Clock::time_point stopping;
    const auto runs = [&](const HostPart& part) { return !hosts_.is_gone(part) && !part.has_ended(); };
    const auto end_all = [&](Ended ended) {
      if (why) return;
      why = std::move(ended);
      stopping = Clock::now();
      for (auto& part : hosts_.all())
        if (runs(*part)) (void)part->say({{"do", "stop"}});
    };
    while (true) {
      if (hosts_.stopped()) end_all({RunResult::Status::interrupted, "", "interrupted", {}});
      if (const auto gone = hosts_.find_gone())
        if (auto restarted = meet_loss(*gone->first, gone->second, running, !why.has_value()); !restarted)
          end_all(hosts_.stopped() ? Ended{RunResult::Status::interrupted, "", "interrupted", {}} : restarted.error());
      bool any = false;
      for (auto& part : hosts_.all()) {
        if (hosts_.is_gone(*part)) continue;
        if (auto heard = part->hear(part->has_ended() ? 0.0 : 0.02); !heard) {
          hosts_.lose(*part);
          end_all({RunResult::Status::failed, "", heard.error(), {}});
        } else if (part->has_ended() && !part->ended().value("complete", false)) {
          end_all(end_of(running.phase, *part));
        }
        note_gaps(*part, running.phase);
        any = any || runs(*part);
      }
      if (!any) break;
      if (auto beaten = hosts_.beat(); !beaten) end_all({RunResult::Status::failed, "", beaten.error(), {}});
      if (why && std::chrono::duration<double>(Clock::now() - stopping).count() > kWaitForStop_s) break;
      show(running.phase);
    }
    for (auto& part : hosts_.all()) note_gaps(*part, running.phase);
    if (why) return tl::unexpected(*why);
    return {};
  }

  /// A part has gone: others take its place, or the run ends.
  tl::expected<void, Ended> meet_loss(HostPart& lost, const std::string& why, const RunningPhase& running, bool may_restart) {
    if (!running.phase.run.restart || !may_restart) {
      hosts_.lose(lost);
      return tl::unexpected(Ended{RunResult::Status::failed, "", why, {}});
    }
    Restart restart(hosts_, running, [&](HostPart& part, const std::string& text) { return note_loss(part, text, running); });
    const auto begin_s = restart.run(lost, why);
    if (!begin_s) return tl::unexpected(begin_s.error());
    for (const std::string& host : restart.restarted()) {
      directory_.note_restart(
          {{"phase", running.phase.name}, {"host", host}, {"epoch", hosts_.epoch(host)}, {"begin_s", *begin_s}});
      warn(host,
           fmt::format("goes on at {:.6g} s, with blocks that have forgotten what was before; what it records is not joined "
                       "with the rest, it lies in restarted/{}",
                       *begin_s, host));
    }
    return {};
  }

  tl::expected<void, Ended> note_loss(HostPart& part, const std::string& why, const RunningPhase& running) {
    note_gaps(part, running.phase);
    if (part.name().empty()) return tl::unexpected(Ended{RunResult::Status::failed, "", why, {}});
    if (++losses_[part.name()] == kMostParts)
      return tl::unexpected(
          Ended{RunResult::Status::failed,
                "",
                fmt::format("host '{}' is lost for the {}th time in this run: it is not started again", part.name(), kMostParts),
                {}});
    warn(part.name(), why + "; it is started again");
    directory_.event("host lost", {{"phase", running.phase.name},
                                   {"host", part.name()},
                                   {"why", why},
                                   {"time_s", part.state().is_object() ? part.state().value("time_s", 0.0) : 0.0}});
    return {};
  }

  void note_gaps(HostPart& part, const graph::Phase& phase) {
    for (json& gap : part.take_gaps()) {
      gap["phase"] = phase.name;
      gap["host"] = part.name();
      directory_.note_gap(gap);
      warn(gap.value("connection", ""),
           fmt::format("{} samples are missing from sample {} on", gap.value("count", 0U), gap.value("first", 0U)));
    }
  }

  static Ended end_of(const graph::Phase& phase, const HostPart& part) {
    Ended ended;
    const json& said = part.ended();
    ended.block = said.value("block", "");
    if (const int block = phase.block_index(ended.block); block >= 0)
      ended.status = phases::failure_of(phase.blocks[static_cast<std::size_t>(block)]);
    if (said.value("interrupted", false)) ended.status = RunResult::Status::interrupted;
    if (said.value("limit", false)) ended.status = RunResult::Status::limit;
    ended.reason = part.name().empty() ? said.value("reason", "") : fmt::format("{}: {}", part.title(), said.value("reason", ""));
    return ended;
  }

  /// Progress of the slowest host, and connections that stand still.
  void show(const graph::Phase& phase) {
    execute::Progress slowest;
    bool any = false;
    for (const auto& part : hosts_.all()) {
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
    if (std::chrono::duration<double>(Clock::now() - shown_).count() < kShow_s) return;
    shown_ = Clock::now();
    json hosts = json::array();
    for (const auto& part : hosts_.all()) {
      const json& state = part->state();
      if (state.is_object())
        hosts.push_back({{"host", part->name()},
                         {"silent_s", part->silent_s()},
                         {"time_s", state.value("time_s", 0.0)},
                         {"rate", state.value("rate", 0.0)},
                         {"pacing", state.value("pacing", json())},
                         {"links", state.value("links", json::array())}});
    }
    (void)board_->say(json{{"run", hosts_.run()}, {"graph", graph_.file}, {"phase", phase.name}, {"hosts", hosts}}.dump());
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

  void keep_results(const graph::Phase& phase, int repeat) {
    for (const auto& part : hosts_.all()) {
      if (!part->has_ended()) continue;
      directory_.add_host(part->name().empty() ? "launcher" : part->name(), phase, repeat, part->ended());
      directory_.event("host ends", {{"phase", phase.name}, {"host", part->name()}, {"end", part->ended()}});
      const json& names = part->ended()["records"];
      for (std::size_t i = 0; i < names.size(); ++i)
        directory_.set_result(phase.name, names[i][0].get<std::string>(), names[i][1].get<std::string>(), part->records()[i]);
    }
  }

  const graph::Graph& graph_;
  record::RunDirectory& directory_;
  const LaunchOptions& options_;
  HostParts hosts_;
  plan::Facts facts_;                  ///< of the phase that runs
  std::map<std::string, int> losses_;  ///< of hosts, in the whole run
  std::set<std::string> stalled_;
  std::unique_ptr<transport::Board> board_;
  Clock::time_point shown_;
};

}  // namespace

RunResult launch(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory,
                 const LaunchOptions& options) {
  return Launch(graph, registry, directory, options).run();
}

bool has_hosts(const graph::Graph& graph) {
  const std::vector<std::string> hosts = hosts_of(graph);
  return !hosts.empty() && !hosts.back().empty();
}

}  // namespace bodeflow::lab
