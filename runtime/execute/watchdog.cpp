#include "execute/watchdog.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <set>
#include <string_view>

namespace bodeflow::execute {
namespace {

std::string output(const Run& run, graph::End end) {
  const graph::Block& block = run.phase->blocks[static_cast<std::size_t>(end.block)];
  return block.name + "." + block.type->port_at(BF_STREAM, BF_OUT, end.port).name;
}

/// What the consumer of a stream edge lacks for its next firing, or "".
std::string wait_on(Run& run, const graph::StreamEdge& edge) {
  BlockRun &from = run.block(edge.from.block), &to = run.block(edge.to.block);
  const auto& flow = run.facts->blocks[static_cast<std::size_t>(to.index)].input_flows[static_cast<std::size_t>(edge.to.port)];
  const auto produced =
      run.facts->blocks[static_cast<std::size_t>(from.index)].output_flows[static_cast<std::size_t>(edge.from.port)].samples;
  const std::int64_t taken = to.reached.load(std::memory_order_relaxed);
  if (taken >= to.end.load(std::memory_order_relaxed)) return "";
  const std::int64_t there =
      from.reached.load(std::memory_order_relaxed) * produced + static_cast<std::int64_t>(flow.delay) - taken * flow.samples;
  if (there >= flow.samples) return "";
  return fmt::format("{} waits for {} sample{} of {}, {} {} there", run.name(to.index), flow.samples,
                     flow.samples == 1 ? "" : "s", output(run, edge.from), std::max<std::int64_t>(there, 0),
                     there == 1 ? "is" : "are");
}

/// The edges along which the stall of `block` spreads.
void add_edges(Run& run, int block, std::vector<std::string>& lines) {
  constexpr std::size_t kMost = 8;
  std::deque<int> blocks{block};
  std::set<int> seen{block};
  while (!blocks.empty() && lines.size() < kMost) {
    const int from = blocks.front();
    blocks.pop_front();
    for (const graph::StreamEdge& edge : run.phase->streams) {
      if (edge.from.block != from || lines.size() >= kMost) continue;
      std::string line = wait_on(run, edge);
      if (line.empty()) continue;
      if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
      if (seen.insert(edge.to.block).second) blocks.push_back(edge.to.block);
    }
  }
}

/// What a waiting thread waits for, where that is no stream edge.
std::string waiting_line(const Run& run, const Lane::Doing& doing) {
  const std::string who = doing.waiting >= 0 ? run.name(doing.waiting) : std::string("the end of the run");
  const std::string& whom = run.name(doing.for_block);
  switch (doing.wait) {
    case Lane::Wait::room:
      return fmt::format("{} waits for room in the ring that {} empties", who, whom);
    case Lane::Wait::records:
      return fmt::format("{} waits for the records of {}", who, whom);
    case Lane::Wait::answer:
      return fmt::format("{} waits for the answer of the asynchronous block {}", who, whom);
    default:
      return fmt::format("{} waits for samples of {}", who, whom);
  }
}

}  // namespace

std::uint64_t calls_of(const std::vector<Member>& members) {
  std::uint64_t calls = 0;
  for (const Member& member : members) calls += member.lane->doing().calls;
  return calls;
}

bool in_finish(const std::vector<Member>& members) {
  return std::any_of(members.begin(), members.end(), [](const Member& member) {
    const Lane::Doing doing = member.lane->doing();
    return !doing.over && doing.wait == Lane::Wait::none && std::string_view(doing.function) == "finish";
  });
}

std::string stall_report(Run& run, const std::vector<Member>& members, double seconds) {
  std::vector<std::string> waits, calls;
  for (const Member& member : members) {
    const Lane::Doing doing = member.lane->doing();
    if (doing.over) continue;
    if (doing.wait != Lane::Wait::none) {
      const auto edge = std::find_if(run.phase->streams.begin(), run.phase->streams.end(), [&](const graph::StreamEdge& e) {
        return e.from.block == doing.for_block && e.to.block == doing.waiting;
      });
      std::string line = doing.wait == Lane::Wait::samples && edge != run.phase->streams.end() ? wait_on(run, *edge) : "";
      if (line.empty()) line = waiting_line(run, doing);
      if (std::find(waits.begin(), waits.end(), line) == waits.end()) waits.push_back(std::move(line));
    } else if (doing.block >= 0) {
      add_edges(run, doing.block, waits);
      calls.push_back(
          fmt::format("{} in {} of block '{}' for {:.3g} s", member.name, doing.function, run.name(doing.block), seconds));
    }
  }
  waits.insert(waits.end(), calls.begin(), calls.end());
  if (waits.empty()) return fmt::format("no progress for {:.3g} s", seconds);
  return fmt::format("{}", fmt::join(waits, "; "));
}

}  // namespace bodeflow::execute
