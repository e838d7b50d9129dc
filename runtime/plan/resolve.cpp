#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "plan/exact.hpp"
#include "plan/facts.hpp"
#include "plan/names.hpp"
#include "plan/order.hpp"

namespace bodeflow::plan {
namespace {

/// Resolving goes on in a loop while facts change; facts that still change after so many times a block never settle.
constexpr int kMostResolves = 16;
/// A rate outside is a loop that runs away, not a signal.
constexpr double kFastest_hz = 1e12, kSlowest_hz = 1e-12;

std::vector<Arc> stream_arcs(const graph::Phase& phase) {
  std::vector<Arc> arcs;
  for (const graph::StreamEdge& edge : phase.streams) arcs.emplace_back(edge.from.block, edge.to.block);
  return arcs;
}

class Resolving {
 public:
  Resolving(const graph::Phase& phase, const Resolver& resolver, Facts& facts)
      : phase_(phase), resolver_(resolver), facts_(facts), feeding_(feeding_edges(phase)) {
    const int count = static_cast<int>(phase.blocks.size());
    components_ = ordered_components(count, stream_arcs(phase));
    rank_.resize(count);
    failed_.assign(count, false);
    resolves_.assign(count, 0);
    readers_.resize(count);
    looped_.resize(count);
    for (const graph::StreamEdge& edge : phase.streams) readers_[edge.from.block].push_back(edge.to.block);
    for (const Component& component : components_) {
      for (const int block : component.nodes) {
        rank_[block] = static_cast<int>(by_rank_.size());
        by_rank_.push_back(block);
        looped_[block] = component.loop;
      }
    }
  }

  Problems run() {
    std::set<int> waiting;  // ranks
    for (std::size_t rank = 0; rank < by_rank_.size(); ++rank) waiting.insert(waiting.end(), static_cast<int>(rank));
    while (!waiting.empty()) {
      const int block = by_rank_[*waiting.begin()];
      waiting.erase(waiting.begin());
      if (resolve(block)) {
        for (const int reader : readers_[block]) waiting.insert(rank_[reader]);
      }
    }
    report_unknown();
    return std::move(problems_);
  }

 private:
  void fail(int block, const Place& place, const std::string& text) {
    failed_[block] = true;
    problems_.push_back({place, text});
  }
  void fail(int block, const std::string& text) {
    fail(block, phase_.blocks[block].place, "block '" + phase_.blocks[block].name + "': " + text);
  }

  /// Whether something upstream failed, so that nothing can be said of this block.
  bool in_the_dark(int block) const {
    return std::any_of(feeding_[block].begin(), feeding_[block].end(),
                       [&](int edge) { return edge >= 0 && failed_[phase_.streams[edge].from.block]; });
  }

  /// Copies what the producers say; false when one gives an element that the port can't take.
  bool take_inputs(int block) {
    Facts::Block& facts = facts_.blocks[block];
    for (std::size_t port = 0; port < facts.inputs.size(); ++port) {
      const int index = feeding_[block][port];
      if (index < 0) continue;
      const graph::StreamEdge& edge = phase_.streams[index];
      facts.inputs[port] = facts_.blocks[edge.from.block].outputs[edge.from.port];
      const std::uint32_t wanted = phase_.blocks[block].type->port_at(BF_STREAM, BF_IN, static_cast<int>(port)).element;
      if (facts.inputs[port].known && wanted != BF_ANY && facts.inputs[port].element != wanted) {
        fail(block, edge.place,
             fmt::format("connection {}: {} gives {}, {} takes {}", connection(phase_, edge), stream_output(phase_, edge.from),
                         element_text(facts.inputs[port].element), stream_input(phase_, edge.to), element_text(wanted)));
        return false;
      }
    }
    return true;
  }

  /// True when the block's outputs changed.
  bool resolve(int block) {
    if (failed_[block]) return false;
    if (in_the_dark(block)) {
      failed_[block] = true;
      return true;
    }
    if (!take_inputs(block)) return true;
    Facts::Block& facts = facts_.blocks[block];
    if (++resolves_[block] > kMostResolves + 4 * static_cast<int>(facts.inputs.size())) {
      not_settled(block);
      return true;
    }
    auto resolution = resolver_(block, facts.inputs);
    if (!resolution) {
      fail(block, resolution.error());
      return true;
    }
    facts.input_flows = std::move(resolution->input_flows);
    facts.output_flows = std::move(resolution->output_flows);
    if (!check_resolution(block, *resolution)) return true;
    std::vector<StreamFacts> before = std::exchange(facts.outputs, std::move(resolution->outputs));
    // A stream ends with the run and with the shortest input, also where the block did not say so.
    const std::int64_t firings = firings_of(phase_, facts);
    for (std::size_t port = 0; port < facts.outputs.size(); ++port) {
      if (facts.outputs[port].known) facts.outputs[port].length = samples_of(firings, facts.output_flows[port]);
    }
    if (looped_[block]) forget_notes(before, facts.outputs);
    return facts.outputs != before;
  }

  /// In a loop notes that a block changes (a gain scales an amplitude) would change again with each pass: there they are no
  /// reason to go on.
  static void forget_notes(std::vector<StreamFacts>& before, const std::vector<StreamFacts>& now) {
    for (std::size_t port = 0; port < std::min(before.size(), now.size()); ++port) before[port].notes = now[port].notes;
  }

  static std::int64_t samples_of(std::int64_t firings, const Flow& flow) {
    return firings < 0 ? -1 : narrow(Wide{firings} * flow.samples).value_or(-1);
  }

  bool check_resolution(int block, const Resolution& said) {
    const BlockDescription& type = *phase_.blocks[block].type;
    const Facts::Block& facts = facts_.blocks[block];
    const std::size_t known_problems = problems_.size();
    for (std::size_t port = 0; port < facts.input_flows.size(); ++port) {
      check_flow(block, facts.input_flows[port], facts.inputs[port], type.port_at(BF_STREAM, BF_IN, static_cast<int>(port)));
    }
    for (std::size_t port = 0; port < said.outputs.size(); ++port) {
      const PortDescription& described = type.port_at(BF_STREAM, BF_OUT, static_cast<int>(port));
      const StreamFacts& output = said.outputs[port];
      if (facts.output_flows[port].samples == 0) fail(block, "output '" + described.name + "' gives no samples");
      if (!output.known) continue;
      if (output.channels == 0) fail(block, "output '" + described.name + "' has no channels");
      if (!output.rate.known()) fail(block, "output '" + described.name + "' has no sample rate");
      if (output.rate.known() && !(output.rate.hz() >= kSlowest_hz && output.rate.hz() <= kFastest_hz)) not_settled(block);
      if (output.element != BF_F64 && output.element != BF_C64) {
        fail(block, "output '" + described.name + "' has no element type");
      } else if (described.element != BF_ANY && described.element != output.element) {
        fail(block, fmt::format("output '{}' is described as {}, but resolved as {}", described.name,
                                element_text(described.element), element_text(output.element)));
      }
    }
    return problems_.size() == known_problems;
  }

  void check_flow(int block, const Flow& flow, const StreamFacts& input, const PortDescription& described) {
    if (flow.samples == 0) fail(block, "input '" + described.name + "' takes no samples");
    if (!input.known || flow.initial.empty()) return;
    const std::uint64_t values = flow.delay * input.channels;
    if (flow.initial.size() != values * (input.element == BF_C64 ? 2 : 1)) {
      fail(block, fmt::format("input '{}' has a delay of {} and {}, but {} initial value{}", described.name,
                              count_text(static_cast<std::int64_t>(flow.delay), "sample"), count_text(input.channels, "channel"),
                              flow.initial.size(), flow.initial.size() == 1 ? "" : "s"));
    }
  }

  /// The component of a block as text: "'a', 'b'".
  std::string partners(int block) const {
    for (const Component& component : components_) {
      if (std::find(component.nodes.begin(), component.nodes.end(), block) == component.nodes.end()) continue;
      std::string text;
      for (const int node : component.nodes) text += (text.empty() ? "'" : ", '") + phase_.blocks[node].name + "'";
      return text;
    }
    return {};
  }

  void not_settled(int block) {
    const Facts::Block& facts = facts_.blocks[block];
    const bool rate = !facts.outputs.empty() && facts.outputs[0].known;
    fail(block, phase_.blocks[block].place,
         "the facts of the loop of " + partners(block) + " do not settle: each pass changes them again" +
             (rate ? " (" + stream_output(phase_, {block, 0}) + " was at " + rate_text(facts.outputs[0].rate) + ")"
                   : std::string()));
  }

  /// Blocks that leave an output unknown, and loops in which each block waits for the other.
  void report_unknown() {
    for (const Component& component : components_) {
      int silent = -1, waiting = -1;
      for (const int block : component.nodes) {
        if (!failed_[block] && in_the_dark(block)) failed_[block] = true;
        if (failed_[block]) continue;
        const Facts::Block& facts = facts_.blocks[block];
        const auto unknown = std::find_if(facts.outputs.begin(), facts.outputs.end(), [](const auto& f) { return !f.known; });
        if (unknown == facts.outputs.end()) continue;
        const auto dark = std::find_if(facts.inputs.begin(), facts.inputs.end(), [&](const StreamFacts& input) {
          return !input.known && feeding_[block][static_cast<std::size_t>(&input - facts.inputs.data())] >= 0;
        });
        if (dark != facts.inputs.end()) {
          waiting = waiting < 0 ? block : waiting;
          continue;
        }
        silent = block;
        fail(block,
             "nothing is known of its output '" +
                 phase_.blocks[block].type->port_at(BF_STREAM, BF_OUT, static_cast<int>(unknown - facts.outputs.begin())).name +
                 "': it says neither channels nor rate");
      }
      if (waiting < 0 || silent >= 0) continue;
      const bool excused = std::any_of(component.nodes.begin(), component.nodes.end(), [&](int block) { return failed_[block]; });
      for (const int block : component.nodes) failed_[block] = true;
      if (excused) continue;
      problems_.push_back(
          {phase_.blocks[waiting].place, "the loop of " + partners(waiting) +
                                             " says nothing about its streams: each block waits to know its inputs; one "
                                             "of them must state its output by itself or from another input"});
    }
  }

  const graph::Phase& phase_;
  const Resolver& resolver_;
  Facts& facts_;
  std::vector<std::vector<int>> feeding_;
  std::vector<Component> components_;
  std::vector<int> rank_, by_rank_, resolves_;
  std::vector<bool> failed_, looped_;
  std::vector<std::vector<int>> readers_;
  Problems problems_;
};

}  // namespace

Problems resolve_blocks(const graph::Phase& phase, const Resolver& resolver, Facts& facts) {
  return Resolving(phase, resolver, facts).run();
}

}  // namespace bodeflow::plan
