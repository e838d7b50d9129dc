#include "lab/host_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lab/collect.hpp"
#include "lab/facts_json.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;
using phases::RunResult;
using Clock = std::chrono::steady_clock;
using Done = tl::expected<void, std::string>;

constexpr double kWaitForAgents_s = 5.0, kWaitForParts_s = 15.0;
constexpr double kBeat_s = 0.5;
/// A part says something five times a second: one that has gone has been silent for so long, with all heard that it had said.
constexpr double kSilent_s = 0.4;
/// An agent that came in the place of a killed one does not know the parts of that one: those that are silent for so long are
/// gone.
constexpr double kVanished_s = 1.0;

tl::unexpected<Ended> failed(std::string reason) {
  return tl::unexpected(Ended{RunResult::Status::failed, "", std::move(reason), {}});
}

}  // namespace

std::vector<std::string> hosts_of(const graph::Graph& graph) {
  std::set<std::string> hosts;
  for (const graph::Phase& phase : graph.phases)
    for (const graph::Block& block : phase.blocks) hosts.insert(block.host);
  return {hosts.begin(), hosts.end()};
}

HostParts::HostParts(const graph::Graph& graph, const Registry& registry, record::RunDirectory& directory,
                     const LaunchOptions& options)
    : graph_(graph), registry_(registry), directory_(directory), options_(options) {
  for (const graph::Phase& phase : graph.phases) tolerance_s_ = std::max(tolerance_s_, phase.run.tolerance_s);
}

Done HostParts::begin() {
  auto participant = transport::join(options_.settings);
  if (!participant) return tl::unexpected(participant.error());
  participant_ = *participant;
  const std::vector<std::string> hosts = hosts_of(graph_);  // this machine first: its part starts while the agents are asked
  std::vector<std::string> others = hosts;
  std::erase(others, "");
  auto lab = Lab::watch(participant_);
  if (!lab) return tl::unexpected(lab.error());
  lab_ = std::move(*lab);
  auto agents = lab_->wait_for(others, kWaitForAgents_s, [this] { return !stopped(); });
  if (!agents) return tl::unexpected(agents.error());
  for (const AgentInfo& agent : *agents)
    if (auto fits = check(agent); !fits)
      return tl::unexpected(
          fmt::format("host '{}' does not fit this machine, nothing was started: {}", agent.name, fits.error()));
  for (const std::string& host : hosts)
    if (auto started = start(host); !started) return started;
  for (auto& part : parts_)
    if (auto connected = connect(*part); !connected) {
      lose(*part);
      return connected;
    }
  for (auto& part : parts_)
    if (auto greeted = greet(*part); !greeted) return tl::unexpected(greeted.error().reason);
  directory_.event("hosts", {{"run", run_}, {"hosts", hosts}});
  return {};
}

/// The same version, plugins and vector level as here.
Done HostParts::check(const AgentInfo& agent) const {
  if (agent.version != options_.version)
    return tl::unexpected(
        fmt::format("bodeflow {} is there, {} here; install the same version", agent.version, options_.version));
  if (agent.vector_level < options_.vector_level)
    return tl::unexpected(fmt::format("its processor has vector level {}, the run uses {}; --isa chooses a lower one",
                                      agent.vector_level, options_.vector_level));
  std::set<std::string> seen;
  for (const graph::Phase& phase : graph_.phases)
    for (const graph::Block& block : phase.blocks) {
      const PluginDescription* mine = block.host == agent.name ? registry_.plugin_of(block.type->id) : nullptr;
      if (mine == nullptr || !seen.insert(mine->name).second) continue;
      const auto theirs =
          std::find_if(agent.plugins.begin(), agent.plugins.end(), [&](const auto& p) { return p.name == mine->name; });
      if (theirs == agent.plugins.end()) return tl::unexpected(fmt::format("it has no plugin '{}'", mine->name));
      if (theirs->version != mine->version)
        return tl::unexpected(fmt::format("plugin '{}' is {} there, {} here", mine->name, theirs->version, mine->version));
      if (theirs->sha256 != mine->sha256)
        return tl::unexpected(fmt::format("plugin '{}' {} is another build there (SHA-256 {:.12} there, {:.12} here)", mine->name,
                                          mine->version, theirs->sha256, mine->sha256));
    }
  return {};
}

tl::expected<std::unique_ptr<HostPart>, std::string> HostParts::open(const std::string& host) {
  auto channel = Channel::open(participant_, part_name(run_, epoch(host)), host, true);
  if (!channel) return tl::unexpected(channel.error());
  return std::make_unique<HostPart>(host, std::move(*channel), tolerance_s_,
                                    [this](const auto& where, const auto& block, int level, const auto& text) {
                                      directory_.log(where.empty() ? block : where + ": " + block, level, text);
                                      if (options_.log) options_.log(where, block, level, text);
                                    });
}

Done HostParts::start(const std::string& host) {
  auto part = open(host);
  if (!part) return tl::unexpected(part.error());
  parts_.push_back(std::move(*part));
  parts_.back()->collect_into(directory_.path() / "hosts" / (host.empty() ? "launcher" : host));
  if (!host.empty()) return ask_for_part(participant_, host, run_, kWaitForAgents_s);
  return own_.start(options_.part_command, part_options(run_, "", directory_.path() / "own_part", options_.settings));
}

std::optional<std::string> HostParts::why_gone(const HostPart& part) {
  if (part.silent_s() < kSilent_s) return std::nullopt;
  const auto process = [&](const std::string& how) { return fmt::format("{} is lost: its process {}", part.title(), how); };
  if (part.name().empty()) return own_.runs() ? std::nullopt : std::optional(process(own_.end_text()));
  const std::string run = part_name(run_, epoch(part.name()));
  bool forgotten = false;
  // An agent that was killed may still be shown beside the one that came in its place.
  for (const AgentInfo& agent : lab_->agents()) {
    if (agent.name != part.name()) continue;
    for (const auto& [ended, how] : agent.ended)
      if (ended == run) return process(how);
    forgotten = forgotten || std::find(agent.runs.begin(), agent.runs.end(), run) == agent.runs.end();
  }
  if (forgotten && part.was_heard() && part.silent_s() > kVanished_s) return process("has gone with its agent, which came back");
  return std::nullopt;
}

std::optional<std::pair<HostPart*, std::string>> HostParts::find_gone() {
  for (auto& part : parts_)
    if (!is_gone(*part) && !part->has_ended())
      if (auto why = why_gone(*part)) return std::pair(part.get(), std::move(*why));
  return std::nullopt;
}

tl::expected<void, Ended> HostParts::start_again(const std::set<std::string>& hosts) {
  ++epoch_;
  for (const std::string& host : hosts)
    if (auto replaced = replace(on(host)); !replaced) return failed(replaced.error());
  for (const std::string& host : hosts) {
    HostPart& part = on(host);
    auto connected = connect(part);
    gone_.erase(&part);
    if (!connected) return failed(connected.error());
    if (auto greeted = greet(part); !greeted) return greeted;
  }
  return {};
}

/// Asks for another process in place of a part's.
Done HostParts::replace(HostPart& lost) {
  const std::string host = lost.name();
  if (!is_gone(lost)) (void)lost.say({{"do", "bye"}});
  lose(lost);
  epochs_[host] = epoch_;
  auto part = open(host);
  if (!part) return tl::unexpected(part.error());
  auto& place = *std::find_if(parts_.begin(), parts_.end(), [&](const auto& p) { return p.get() == &lost; });
  lost_.push_back(std::exchange(place, std::move(*part)));
  lose(*place);  // it can't be told anything before it has come
  // What was recorded in pieces is not joined with what the other hosts have: it lies beside.
  place->collect_into(directory_.path() / "restarted" / host);
  // No receipt comes as long as the network believes in the reader of an agent that was killed; that the part comes tells enough.
  requests_.push_back(std::async(std::launch::async, [participant = participant_, host, name = part_name(run_, epoch_)] {
    (void)ask_for_part(participant, host, name, kWaitForAgents_s);
  }));
  return {};
}

Done HostParts::connect(HostPart& part) {
  const auto until = Clock::now() + std::chrono::duration<double>(kWaitForParts_s);
  std::optional<std::string> gone;
  const auto goes_on = [&] {
    if (epoch(part.name()) > 0) (void)beat();  // the others run
    if (!gone) gone = why_gone(part);
    return !stopped() && Clock::now() < until && !gone;
  };
  auto connected = part.channel().connect(goes_on);
  if (gone && !connected) return tl::unexpected(*gone);
  if (!connected) return tl::unexpected(fmt::format("{} did not start its part: {}", part.title(), connected.error()));
  return {};
}

/// Gives a part the graph and what holds for the whole run.
tl::expected<void, Ended> HostParts::greet(HostPart& part) {
  json begin = {{"do", "begin"},
                {"graph", graph_.expanded},
                {"file", graph_.file},
                {"name", std::filesystem::path(graph_.file).stem().string()},
                {"manifest", {{"run", run_}, {"host", part.name()}, {"epoch", epoch(part.name())}}},
                {"tolerance_s", tolerance_s_},
                {"vector_level", options_.vector_level}};
  if (options_.plan.chunk) begin["chunk"] = *options_.plan.chunk;
  if (options_.plan.threads) begin["threads"] = *options_.plan.threads;
  if (auto answer = ask(part, begin); !answer) return tl::unexpected(answer.error());
  return {};
}

HostPart& HostParts::on(const std::string& host) const {
  return **std::find_if(parts_.begin(), parts_.end(), [&](const auto& part) { return part->name() == host; });
}

Done HostParts::beat() {
  if (std::chrono::duration<double>(Clock::now() - beaten_).count() < kBeat_s) return {};
  beaten_ = Clock::now();
  return tell_all({{"do", "beat"}});
}

Done HostParts::tell_all(const json& message) {
  for (auto& part : parts_)
    if (!is_gone(*part))
      if (auto said = part->say(message); !said) return said;
  return {};
}

tl::expected<json, Ended> HostParts::ask(HostPart& part, const json& question) {
  if (auto said = part.say(question); !said) return failed(said.error());
  return wait_for_answer(part);
}

tl::expected<void, Ended> HostParts::ask_all(const json& question) {
  if (auto told = tell_all(question); !told) return failed(told.error());
  for (auto& part : parts_) {
    if (is_gone(*part)) continue;
    if (auto answer = wait_for_answer(*part); !answer) return tl::unexpected(answer.error());
  }
  return {};
}

tl::expected<json, Ended> HostParts::wait_for_answer(HostPart& part) {
  while (true) {
    if (stopped()) return tl::unexpected(Ended{RunResult::Status::interrupted, "", "interrupted", {}});
    Done fine = part.hear(0.02);
    for (auto& other : parts_)
      if (fine && other.get() != &part && !is_gone(*other)) fine = other->hear(0.0);
    if (fine) fine = beat();
    if (!fine) return failed(fine.error());
    auto answer = part.take_answer();
    if (!answer) {
      if (const auto gone = find_gone()) return failed(gone->second);
      continue;
    }
    if (answer->contains("problems")) {
      Problems problems = problems_from((*answer)["problems"]);
      return tl::unexpected(Ended{RunResult::Status::rejected, "", to_string(problems), problems});
    }
    if (answer->contains("error")) return failed(fmt::format("{}: {}", part.title(), (*answer)["error"].get<std::string>()));
    return *answer;
  }
}

void HostParts::finish(RunResult& result) {
  const auto spoil = [&](const std::string& reason) {
    if (result.status == RunResult::Status::complete) result = {RunResult::Status::failed, result.phase, "", reason, {}, false};
  };
  for (auto& part : parts_) {
    if (is_gone(*part)) continue;
    const auto collected = collect(*part, result);
    if (!collected) {
      spoil(collected.error());
      if (options_.log) options_.log(part->name(), "collection", BF_LOG_ERROR, collected.error());
    }
    lose(*part);
    (void)part->say({{"do", "bye"}, {"fetched", collected.has_value()}});
    part->channel().drain(1.0);
  }
  if (auto merged = merge_hosts(directory_); !merged) spoil(merged.error());
  own_.end();
}

Done HostParts::collect(HostPart& part, const RunResult& result) {
  if (auto said = part.say({{"do", "close"}, {"status", phases::status_word(result.status)}, {"reason", result.reason}}); !said)
    return said;
  while (!part.collected()) {
    if (auto heard = part.hear(0.1); !heard) return heard;
    if (const auto gone = why_gone(part)) return tl::unexpected(*gone);
    if (auto beaten = beat(); !beaten) return beaten;
  }
  if (!part.close_error().empty()) return tl::unexpected(fmt::format("{}: {}", part.title(), part.close_error()));
  return {};
}

}  // namespace bodeflow::lab
