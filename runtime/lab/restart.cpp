// A lost host's part is started again in the middle of a phase.
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

/// How its chunks lie in the time of the phase.
struct Grid {
  std::int64_t periods = 1;  ///< of the phase in a chunk
  double period_s = 0.0;
};

tl::expected<Grid, Ended> make_blocks(HostParts& hosts, HostPart& part, const RunningPhase& running) {
  const json make = {{"do", "phase"}, {"phase", running.index}, {"repeat", running.repeat}};
  if (auto made = hosts.ask(part, make); !made) return tl::unexpected(made.error());
  for (std::size_t i = 0; i < running.phase.blocks.size(); ++i) {
    const graph::Block& block = running.phase.blocks[i];
    if (block.host != part.name()) continue;
    auto answer =
        hosts.ask(part, {{"do", "resolve"}, {"block", block.name}, {"inputs", to_json(running.facts.blocks[i].inputs)}});
    if (!answer) return tl::unexpected(answer.error());
    if (answer->contains("refused"))
      return tl::unexpected(Ended{phases::RunResult::Status::failed, block.name, (*answer)["refused"].get<std::string>(), {}});
  }
  auto prepared = hosts.ask(part, {{"do", "prepare"}, {"facts", to_json(running.facts)}});
  if (!prepared) return tl::unexpected(prepared.error());
  return Grid{prepared->value("chunk", std::int64_t{1}), prepared->value("period_s", 0.0)};
}

/// The others let go of their links to the lost host: the first period that nobody has sent to it or has got from it.
tl::expected<std::int64_t, Ended> leave(HostParts& hosts, const std::string& host) {
  std::int64_t period = 0;
  for (const auto& part : hosts.all()) {
    if (part->name() == host) continue;
    auto answer = hosts.ask(*part, {{"do", "leave"}, {"host", host}});
    if (!answer) return failed(fmt::format("host '{}' is lost and can't go on: {}", host, answer.error().reason));
    period = std::max(period, answer->value("period", std::int64_t{0}));
  }
  return period;
}

/// New links between the new part and the others.
tl::expected<void, Ended> connect(HostParts& hosts, const std::string& host) {
  const json links = {{"links", part_name(hosts.run(), hosts.epoch(host))}, {"epoch", hosts.epoch(host)}};
  for (const auto& part : hosts.all()) {
    json wish = links;
    wish["do"] = part->name() == host ? "connect" : "rejoin";
    wish["host"] = host;
    if (auto said = part->say(wish); !said) return failed(said.error());
  }
  for (const auto& part : hosts.all())
    if (auto answer = hosts.wait_for_answer(*part); !answer) return tl::unexpected(answer.error());
  return {};
}

/// Where the new part begins: not before `least`, and where the clock paces a phase whose lost time is made up for, at the chunk
/// whose time it is.
std::int64_t begin_of(std::int64_t least, const Grid& grid, const RunningPhase& running) {
  const graph::RunSettings& run = running.phase.run;
  if (run.clock != graph::Clock::simulated && run.on_overrun != graph::Overrun::skip && grid.period_s > 0.0) {
    const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - running.started).count();
    least = std::max(least, static_cast<std::int64_t>(std::ceil(now_s / grid.period_s)));
  }
  return (least + grid.periods - 1) / grid.periods * grid.periods;
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

tl::expected<double, Ended> restart(HostParts& hosts, HostPart& lost, const RunningPhase& running) {
  const std::string host = lost.name();
  hosts.lose(lost);
  const auto least = leave(hosts, host);  // first: links to a lost part bear its silence only for the tolerance
  if (!least) return tl::unexpected(least.error());
  auto part = hosts.start_again(lost);
  if (!part) return tl::unexpected(part.error());
  const auto grid = make_blocks(hosts, **part, running);
  if (!grid) return tl::unexpected(grid.error());
  if (auto connected = connect(hosts, host); !connected) return tl::unexpected(connected.error());
  const std::int64_t period = begin_of(*least, *grid, running);
  const auto begun = hosts.ask(**part, {{"do", "begin_at"}, {"period", period}});
  if (!begun) return tl::unexpected(begun.error());
  for (const auto& other : hosts.all())
    if (other->name() != host)
      if (auto gone_on = hosts.ask(*other, {{"do", "go_on"}, {"host", host}, {"period", period}}); !gone_on)
        return tl::unexpected(gone_on.error());
  const std::uint64_t seed =
      phases::seed_of(running.phase, running.repeat) + kOtherSeed * static_cast<std::uint64_t>(hosts.epoch(host));
  if (auto started = begin_phase(**part, running.initial, seed); !started) return failed(started.error());
  return begun->value("begin_s", 0.0);
}

}  // namespace bodeflow::lab
