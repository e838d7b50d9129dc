#include "plan/facts.hpp"

namespace bodeflow::plan {

Facts empty_facts(const graph::Phase& phase) {
  Facts facts;
  for (const graph::Block& block : phase.blocks) {
    const int inputs = block.type->count(BF_STREAM, BF_IN), outputs = block.type->count(BF_STREAM, BF_OUT);
    Facts::Block& made = facts.blocks.emplace_back();
    made.inputs.resize(inputs);
    made.outputs.resize(outputs);
    made.input_flows.resize(inputs);
    made.output_flows.resize(outputs);
  }
  return facts;
}

std::vector<std::vector<int>> feeding_edges(const graph::Phase& phase) {
  std::vector<std::vector<int>> feeding;
  for (const graph::Block& block : phase.blocks) feeding.emplace_back(block.type->count(BF_STREAM, BF_IN), -1);
  for (std::size_t i = 0; i < phase.streams.size(); ++i) {
    const graph::End& to = phase.streams[i].to;
    feeding[to.block][to.port] = static_cast<int>(i);
  }
  return feeding;
}

tl::expected<Facts, Problems> establish_facts(const graph::Phase& phase, const Resolver& resolver) {
  Facts facts = empty_facts(phase);
  Problems problems = resolve_blocks(phase, resolver, facts);
  if (problems.empty()) problems = check_rates(phase, facts);
  if (problems.empty()) problems = balance_phase(phase, facts);
  if (problems.empty()) problems = find_ends(phase, facts);
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return facts;
}

}  // namespace bodeflow::plan
