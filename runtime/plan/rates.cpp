#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "plan/balance.hpp"
#include "plan/exact.hpp"
#include "plan/facts.hpp"
#include "plan/names.hpp"

namespace bodeflow::plan {
namespace {

/// Samples of one stream in one period of the phase, at most: what must fit into memory whatever the chunk.
constexpr std::int64_t kMostSamples = std::int64_t{1} << 22;
/// Rates listed in a message, at most.
constexpr std::size_t kMostNamed = 6;

/// Rate of the block's firings by one of its ports.
Rate per_firing(const StreamFacts& stream, const Flow& flow) {
  return stream.known ? divide(stream.rate, Rate{flow.samples, 1}).value_or(Rate{}) : Rate{};
}

std::string clock_text(const std::string& clock) { return clock.empty() ? "the engine's clock" : "clock '" + clock + "'"; }

/// Inputs of one block against each other: rate and clock domain.
void check_inputs(const graph::Phase& phase, const std::vector<int>& feeding, int block, const Facts::Block& facts,
                  Problems& problems) {
  int first = -1;
  for (int port = 0; port < static_cast<int>(facts.inputs.size()); ++port) {
    if (!facts.inputs[port].known) continue;
    if (first < 0) {
      first = port;
      continue;
    }
    const graph::StreamEdge& edge = phase.streams[feeding[port]];
    const StreamFacts &a = facts.inputs[first], &b = facts.inputs[port];
    const std::string at_a = stream_input(phase, {block, first}), at_b = stream_input(phase, {block, port});
    const std::string from_a = stream_output(phase, phase.streams[feeding[first]].from), from_b = stream_output(phase, edge.from);
    if (per_firing(a, facts.input_flows[first]) != per_firing(b, facts.input_flows[port])) {
      const bool plain = facts.input_flows[first].samples == 1 && facts.input_flows[port].samples == 1;
      const auto taken = [&](int p) {
        return plain ? std::string() : " (" + count_text(facts.input_flows[p].samples, "sample") + " a firing)";
      };
      problems.push_back(
          {edge.place, fmt::format("{} gets {} from {}{}, {} gets {} from {}{}; put filters.hold or filters.decimate "
                                   "between",
                                   at_a, rate_text(a.rate), from_a, taken(first), at_b, rate_text(b.rate), from_b, taken(port))});
    } else if (a.clock != b.clock && !phase.blocks[block].type->has_role("resampler")) {
      problems.push_back({edge.place, fmt::format("{} runs on {} ({}), {} on {} ({}); needs a resampler", at_a,
                                                  clock_text(a.clock), from_a, at_b, clock_text(b.clock), from_b)});
    }
  }
}

void check_outputs(const graph::Phase& phase, int block, const Facts::Block& facts, Problems& problems) {
  for (int port = 0; port < static_cast<int>(facts.outputs.size()); ++port) {
    const std::uint32_t samples = facts.output_flows[port].samples;
    const Rate expected = multiply(facts.firing_rate, Rate{samples, 1}).value_or(Rate{});
    if (facts.outputs[port].rate == expected) continue;
    problems.push_back(
        {phase.blocks[block].place,
         fmt::format("block '{}': output '{}' states {}, but fires {} times a second with {} each: {}", phase.blocks[block].name,
                     phase.blocks[block].type->port_at(BF_STREAM, BF_OUT, port).name, rate_text(facts.outputs[port].rate),
                     fmt::format("{:.10g}", facts.firing_rate.hz()), count_text(samples, "sample"), rate_text(expected))});
  }
}

/// A stream changes its clock domain in a resampler alone.
void check_clock(const graph::Phase& phase, int block, const Facts::Block& facts, Problems& problems) {
  if (phase.blocks[block].type->has_role("resampler")) return;
  const auto input = std::find_if(facts.inputs.begin(), facts.inputs.end(), [](const StreamFacts& f) { return f.known; });
  if (input == facts.inputs.end()) return;
  for (int port = 0; port < static_cast<int>(facts.outputs.size()); ++port) {
    if (!facts.outputs[port].known || facts.outputs[port].clock == input->clock) continue;
    problems.push_back(
        {phase.blocks[block].place,
         fmt::format("block '{}': {} runs on {}, {} on {}; only a resampler takes a stream to another clock",
                     phase.blocks[block].name, stream_input(phase, {block, static_cast<int>(input - facts.inputs.begin())}),
                     clock_text(input->clock), stream_output(phase, {block, port}), clock_text(facts.outputs[port].clock))});
  }
}

/// "44.1 kHz (a.out), 48 kHz (b.out)": the different rates of the phase, each with the first stream that has it.
std::string rates_of(const graph::Phase& phase, const Facts& facts) {
  std::vector<Rate> named;
  std::string text;
  for (int block = 0; block < static_cast<int>(facts.blocks.size()); ++block) {
    for (int port = 0; port < static_cast<int>(facts.blocks[block].outputs.size()); ++port) {
      const Rate& rate = facts.blocks[block].outputs[port].rate;
      if (std::find(named.begin(), named.end(), rate) != named.end()) continue;
      named.push_back(rate);
      if (named.size() > kMostNamed) return text + ", ...";
      text += (text.empty() ? "" : ", ") + rate_text(rate) + " (" + stream_output(phase, {block, port}) + ")";
    }
  }
  return text;
}

Problem no_period(const graph::Phase& phase, const Facts& facts, const std::string& why) {
  return {phase.place, "the sample rates have no short common period: " + rates_of(phase, facts) + "; " + why +
                           "; choose rates in a simple ratio"};
}

/// Checks that no stream needs too many samples in a period.
Problems check_period(const graph::Phase& phase, const Facts& facts) {
  std::int64_t most = 0;
  graph::End where;
  for (int block = 0; block < static_cast<int>(facts.blocks.size()); ++block) {
    const Facts::Block& b = facts.blocks[block];
    for (int port = 0; port < static_cast<int>(b.outputs.size()); ++port) {
      const auto samples = narrow(Wide{b.repetitions} * b.output_flows[port].samples).value_or(INT64_MAX);
      if (samples <= most) continue;
      most = samples;
      where = {block, port};
    }
  }
  if (most <= kMostSamples) return {};
  return {no_period(phase, facts,
                    fmt::format("one period of {} has {} samples of {}, more than {}", seconds_text(facts.period.hz()), most,
                                stream_output(phase, where), kMostSamples))};
}

}  // namespace

Rate firing_rate_of(const Facts::Block& block) {
  for (std::size_t port = 0; port < block.inputs.size(); ++port) {
    if (block.inputs[port].known) return per_firing(block.inputs[port], block.input_flows[port]);
  }
  for (std::size_t port = 0; port < block.outputs.size(); ++port) {
    if (block.outputs[port].known) return per_firing(block.outputs[port], block.output_flows[port]);
  }
  return {};
}

Problems check_rates(const graph::Phase& phase, Facts& facts) {
  Problems problems;
  const auto feeding = feeding_edges(phase);
  for (int block = 0; block < static_cast<int>(facts.blocks.size()); ++block) {
    Facts::Block& b = facts.blocks[block];
    b.firing_rate = firing_rate_of(b);
    const std::size_t before = problems.size();
    check_inputs(phase, feeding[block], block, b, problems);
    if (problems.size() == before) check_outputs(phase, block, b, problems);
    if (problems.size() == before) check_clock(phase, block, b, problems);
  }
  return problems;
}

Problems balance_phase(const graph::Phase& phase, Facts& facts) {
  std::vector<BalanceEdge> edges;
  for (const graph::StreamEdge& edge : phase.streams) {
    edges.push_back({edge.from.block, edge.to.block, facts.blocks[edge.from.block].output_flows[edge.from.port].samples,
                     facts.blocks[edge.to.block].input_flows[edge.to.port].samples});
  }
  const int count = static_cast<int>(facts.blocks.size());
  const auto solved = balance(count, edges);
  if (!solved) {
    if (solved.error().overflow || solved.error().edge < 0) return {no_period(phase, facts, "their ratio is beyond 64 bits")};
    const graph::StreamEdge& edge = phase.streams[solved.error().edge];
    return {{edge.place, "connection " + connection(phase, edge) + ": no number of firings balances it: " +
                             count_text(edges[solved.error().edge].produced, "sample") + " a firing on one end, " +
                             count_text(edges[solved.error().edge].consumed, "sample") + " on the other"}};
  }
  const auto part_period = [&](int block) {
    return divide(Rate{solved->repetitions[block], 1}, facts.blocks[block].firing_rate);
  };
  std::set<int> parts;
  for (int block = 0; block < count; ++block) {
    if (!facts.blocks[block].firing_rate.known() || !parts.insert(solved->part[block]).second) continue;
    const auto period = part_period(block);
    const auto common = !period ? std::nullopt : facts.period.num == 0 ? period : common_multiple(facts.period, *period);
    if (!common) return {no_period(phase, facts, "their common period is beyond 64 bits")};
    facts.period = *common;
  }
  for (int block = 0; block < count; ++block) {
    Facts::Block& b = facts.blocks[block];
    if (b.firing_rate.known()) b.repetitions = whole_firings(facts.period, b.firing_rate);
  }
  return check_period(phase, facts);
}

}  // namespace bodeflow::plan
