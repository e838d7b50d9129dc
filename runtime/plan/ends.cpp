#include <algorithm>

#include "plan/exact.hpp"
#include "plan/facts.hpp"
#include "plan/names.hpp"

namespace bodeflow::plan {
namespace {

void shorten(std::int64_t& firings, std::int64_t limit) {
  if (limit >= 0 && (firings < 0 || limit < firings)) firings = limit;
}

/// "'a', 'b'" of the endless blocks that nothing feeds; where there is none, of all endless ones.
std::string endless_sources(const graph::Phase& phase, const Facts& facts, int& first) {
  std::string sources, all;
  int first_source = -1, first_block = -1;
  const auto add = [&](std::string& text, int& index, int block) {
    text += (text.empty() ? "'" : ", '") + phase.blocks[block].name + "'";
    if (index < 0) index = block;
  };
  for (int block = 0; block < static_cast<int>(facts.blocks.size()); ++block) {
    const Facts::Block& b = facts.blocks[block];
    if (!b.firing_rate.known() || b.firings >= 0) continue;
    add(all, first_block, block);
    if (std::none_of(b.inputs.begin(), b.inputs.end(), [](const StreamFacts& input) { return input.known; })) {
      add(sources, first_source, block);
    }
  }
  first = first_source >= 0 ? first_source : first_block;
  return sources.empty() ? all : sources;
}

/// The blocks with an end, and all that feeds one of those, directly or not: these stop with it.
std::vector<bool> ending_blocks(const graph::Phase& phase, const Facts& facts) {
  std::vector<std::vector<int>> producers(facts.blocks.size());
  for (const graph::StreamEdge& edge : phase.streams) producers[edge.to.block].push_back(edge.from.block);
  std::vector<bool> ending(facts.blocks.size(), false);
  std::vector<int> found;
  for (int block = 0; block < static_cast<int>(facts.blocks.size()); ++block) {
    ending[block] = facts.blocks[block].firings >= 0;
    if (ending[block]) found.push_back(block);
  }
  while (!found.empty()) {
    const int block = found.back();
    found.pop_back();
    for (const int producer : producers[block]) {
      if (ending[producer]) continue;
      ending[producer] = true;
      found.push_back(producer);
    }
  }
  return ending;
}

void set_lengths(Facts& facts, const graph::Phase& phase) {
  for (Facts::Block& block : facts.blocks) {
    for (std::size_t port = 0; port < block.outputs.size(); ++port) {
      if (block.outputs[port].known && block.firings >= 0) {
        block.outputs[port].length = narrow(Wide{block.firings} * block.output_flows[port].samples).value_or(-1);
      }
    }
  }
  for (const graph::StreamEdge& edge : phase.streams) {
    facts.blocks[edge.to.block].inputs[edge.to.port].length = facts.blocks[edge.from.block].outputs[edge.from.port].length;
  }
}

void warn_of_silence(const graph::Phase& phase, Facts& facts) {
  for (std::size_t block = 0; block < facts.blocks.size(); ++block) {
    if (!facts.blocks[block].firing_rate.known() || facts.blocks[block].firings != 0) continue;
    facts.warnings.push_back("block '" + phase.blocks[block].name + "' never fires: the run ends before its first " +
                             seconds_text(1.0 / facts.blocks[block].firing_rate.hz()) + " are over");
  }
}

}  // namespace

std::int64_t firings_of(const graph::Phase& phase, const Facts::Block& block) {
  std::int64_t firings = -1;
  const Rate rate = firing_rate_of(block);
  if (phase.run.duration_s && rate.known()) shorten(firings, whole_firings(Rate::from_hz(*phase.run.duration_s), rate));
  for (std::size_t port = 0; port < block.inputs.size(); ++port) {
    const StreamFacts& input = block.inputs[port];
    if (input.known && input.length >= 0) shorten(firings, input.length / block.input_flows[port].samples);
  }
  for (std::size_t port = 0; port < block.outputs.size(); ++port) {
    const StreamFacts& output = block.outputs[port];
    if (output.known && output.length >= 0) shorten(firings, output.length / block.output_flows[port].samples);
  }
  return firings;
}

Problems find_ends(const graph::Phase& phase, Facts& facts) {
  Rate end;
  for (Facts::Block& block : facts.blocks) {
    block.firings = firings_of(phase, block);
    if (block.firings < 0) continue;
    const Rate mine = divide(Rate{block.firings, 1}, block.firing_rate).value_or(Rate{});
    if (less(end, mine)) end = mine;
  }
  const std::vector<bool> ending = ending_blocks(phase, facts);
  bool endless = false;
  for (std::size_t i = 0; i < ending.size(); ++i) endless = endless || (!ending[i] && facts.blocks[i].firing_rate.known());
  if (endless) {
    int first = 0;
    const std::string sources = endless_sources(phase, facts, first);
    return {{phase.blocks[first].place, "the run has no end: nothing limits " + sources + "; set run.duration"}};
  }
  // A source without end of its own stops when the last block that has one does.
  for (Facts::Block& block : facts.blocks) {
    if (block.firing_rate.known() && block.firings < 0) block.firings = covering_firings(end, block.firing_rate);
  }
  set_lengths(facts, phase);
  warn_of_silence(phase, facts);
  return {};
}

}  // namespace bodeflow::plan
