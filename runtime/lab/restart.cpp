// The parts of lost hosts are started again in the middle of a phase.
#include "lab/restart.hpp"

#include <fmt/format.h>

#include <cmath>

#include "lab/facts_json.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;

/// A part that goes on draws other random numbers than the lost one did.
constexpr std::uint64_t kOtherSeed = 0x9E3779B97F4A7C15U;

tl::unexpected<Ended> failed(std::string reason) {
  return tl::unexpected(Ended{phases::RunResult::Status::failed, "", std::move(reason), {}});
}

}  // namespace

tl::expected<void, std::string> begin_phase(HostPart& part, const std::vector<execute::InitialRecord>& initial,
                                            std::uint64_t seed) {
  json list = json::array();
  for (const execute::InitialRecord& record : initial) {
    list.push_back({record.to.block, record.to.port});
    if (auto sent = part.send({reinterpret_cast<const std::byte*>(record.record.bytes()), record.record.size()}); !sent)
      return sent;
  }
  return part.say({{"do", "run"}, {"initial", list}, {"seed", seed}});
}

tl::expected<double, Ended> Restart::run(HostPart& lost, const std::string& why) {
  if (auto gone = lose(lost, why); !gone) return tl::unexpected(gone.error());
  while (true) {
    auto begun = start();
    if (begun || hosts_.stopped()) return begun;
    const auto next = hosts_.find_gone();
    if (!next) return begun;
    if (auto gone = lose(*next->first, next->second); !gone) return tl::unexpected(gone.error());
  }
}

tl::expected<void, Ended> Restart::lose(HostPart& part, const std::string& why) {
  hosts_.lose(part);
  away_.insert(part.name());
  return on_lost_(part, why);
}

tl::expected<double, Ended> Restart::start() {
  const auto least = leave();  // first: links to a lost part bear its silence only for the tolerance
  if (!least) return tl::unexpected(least.error());
  if (auto started = hosts_.start_again(away_); !started) return tl::unexpected(started.error());
  for (const std::string& host : away_)
    if (auto made = make_blocks(hosts_.on(host)); !made) return tl::unexpected(made.error());
  if (auto connected = connect(); !connected) return tl::unexpected(connected.error());
  const std::int64_t period = begin_of(*least);
  double begin_s = 0.0;
  for (const std::string& host : away_) {
    const auto begun = hosts_.ask(hosts_.on(host), {{"do", "begin_at"}, {"period", period}});
    if (!begun) return tl::unexpected(begun.error());
    begin_s = begun->value("begin_s", 0.0);
  }
  for (const auto& part : hosts_.all()) {
    if (is_away(*part)) continue;
    for (const std::string& host : away_)
      if (auto gone_on = hosts_.ask(*part, {{"do", "go_on"}, {"host", host}, {"period", period}}); !gone_on)
        return tl::unexpected(gone_on.error());
  }
  for (const std::string& host : away_) {
    const std::uint64_t seed =
        phases::seed_of(running_.phase, running_.repeat) + kOtherSeed * static_cast<std::uint64_t>(hosts_.epoch(host));
    if (auto begun = begin_phase(hosts_.on(host), running_.initial, seed); !begun) return failed(begun.error());
  }
  return begin_s;
}

/// The others let go of their links to the lost hosts: the first period that nobody has sent to them or has got from them.
tl::expected<std::int64_t, Ended> Restart::leave() {
  std::int64_t period = 0;
  for (const auto& part : hosts_.all()) {
    if (is_away(*part)) continue;
    for (const std::string& host : away_) {
      auto answer = hosts_.ask(*part, {{"do", "leave"}, {"host", host}});
      if (!answer) return failed(fmt::format("host '{}' is lost and can't go on: {}", host, answer.error().reason));
      period = std::max(period, answer->value("period", std::int64_t{0}));
    }
  }
  return period;
}

tl::expected<void, Ended> Restart::make_blocks(HostPart& part) {
  const json make = {{"do", "phase"}, {"phase", running_.index}, {"repeat", running_.repeat}};
  if (auto made = hosts_.ask(part, make); !made) return tl::unexpected(made.error());
  for (std::size_t i = 0; i < running_.phase.blocks.size(); ++i) {
    const graph::Block& block = running_.phase.blocks[i];
    if (block.host != part.name()) continue;
    auto answer =
        hosts_.ask(part, {{"do", "resolve"}, {"block", block.name}, {"inputs", to_json(running_.facts.blocks[i].inputs)}});
    if (!answer) return tl::unexpected(answer.error());
    if (answer->contains("refused"))
      return tl::unexpected(Ended{phases::RunResult::Status::failed, block.name, (*answer)["refused"].get<std::string>(), {}});
  }
  auto prepared = hosts_.ask(part, {{"do", "prepare"}, {"facts", to_json(running_.facts)}});
  if (!prepared) return tl::unexpected(prepared.error());
  chunk_ = prepared->value("chunk", std::int64_t{1});
  period_s_ = prepared->value("period_s", 0.0);
  return {};
}

/// New links between the new parts and all others.
tl::expected<void, Ended> Restart::connect() {
  const int epoch = hosts_.epoch(*away_.begin());
  const json links = {{"links", part_name(hosts_.run(), epoch)}, {"epoch", epoch}};
  const auto say = [&](HostPart& part, const char* what, const std::string& host) -> tl::expected<void, Ended> {
    json wish = links;
    wish["do"] = what;
    wish["host"] = host;
    if (auto said = part.say(wish); !said) return failed(said.error());
    return {};
  };
  for (const std::string& host : away_)
    if (auto said = say(hosts_.on(host), "connect", host); !said) return said;
  for (const std::string& host : away_) {
    for (const auto& part : hosts_.all())
      if (!is_away(*part))
        if (auto said = say(*part, "rejoin", host); !said) return said;
    for (const auto& part : hosts_.all())
      if (!is_away(*part))
        if (auto answer = hosts_.wait_for_answer(*part); !answer) return tl::unexpected(answer.error());
  }
  for (const std::string& host : away_)
    if (auto answer = hosts_.wait_for_answer(hosts_.on(host)); !answer) return tl::unexpected(answer.error());
  return {};
}

/// Where the new parts begin: not before `least`, and where the clock paces a phase whose lost time is made up for, at the chunk
/// whose time it is.
std::int64_t Restart::begin_of(std::int64_t least) const {
  const graph::RunSettings& run = running_.phase.run;
  if (run.clock != graph::Clock::simulated && run.on_overrun != graph::Overrun::skip && period_s_ > 0.0) {
    const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - running_.started).count();
    least = std::max(least, static_cast<std::int64_t>(std::ceil(now_s / period_s_)));
  }
  return (least + chunk_ - 1) / chunk_ * chunk_;
}

}  // namespace bodeflow::lab
