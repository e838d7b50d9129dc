// The blocks of one host as a phase of its own.
#include <fmt/format.h>

#include <algorithm>

#include "lab/remote_blocks.hpp"
#include "plan/exact.hpp"

namespace bodeflow::lab {
namespace {

class Parting {
 public:
  Parting(const graph::Phase& phase, const plan::Facts& facts, const Layout& layout, const std::string& host)
      : phase_(phase),
        facts_(facts),
        layout_(layout),
        host_(host),
        local_(phase.blocks.size(), -1),
        end_(layout.cuts.size(), -1) {}

  Part run(const plan::PlanOptions& options) {
    part_.phase.name = phase_.name;
    part_.phase.place = phase_.place;
    part_.phase.run = phase_.run;
    part_.facts.period = has_records() && facts_.period.num == 0 ? Rate{1, 1} : facts_.period;
    for (const auto& step : layout_.steps) add_step(step);
    add_streams();
    add_messages();
    add_rest();
    part_.options = options;
    part_.options.periods = layout_.periods;
    part_.options.kept.clear();
    for (const auto& recorded : part_.phase.recorded)
      if (recorded.kind == BF_STREAM) part_.options.kept.push_back(recorded.port);
    return std::move(part_);
  }

 private:
  bool mine(int block) const { return phase_.blocks[static_cast<std::size_t>(block)].host == host_; }
  int local(int block) const { return local_[static_cast<std::size_t>(block)]; }
  graph::End local(const graph::End& end) const { return {local(end.block), end.port}; }
  const graph::End& from(const Cut& cut) const {
    return cut.message ? phase_.messages[static_cast<std::size_t>(cut.edge)].from
                       : phase_.streams[static_cast<std::size_t>(cut.edge)].from;
  }
  const graph::End& to(const Cut& cut) const {
    return cut.message ? phase_.messages[static_cast<std::size_t>(cut.edge)].to
                       : phase_.streams[static_cast<std::size_t>(cut.edge)].to;
  }
  bool has_records() const {
    return std::any_of(layout_.cuts.begin(), layout_.cuts.end(), [](const Cut& cut) { return cut.message; });
  }

  /// What comes in stands before the blocks of a step, what goes out behind.
  void add_step(const std::vector<int>& step) {
    if (!mine(step.front())) return;
    const auto inside = [&](int block) { return std::find(step.begin(), step.end(), block) != step.end(); };
    for (std::size_t i = 0; i < layout_.cuts.size(); ++i)
      if (layout_.cuts[i].to_host == host_ && inside(to(layout_.cuts[i]).block)) add_end(static_cast<int>(i), false);
    for (const int block : step) {
      local_[static_cast<std::size_t>(block)] = static_cast<int>(part_.phase.blocks.size());
      part_.phase.blocks.push_back(phase_.blocks[static_cast<std::size_t>(block)]);
      part_.facts.blocks.push_back(facts_.blocks[static_cast<std::size_t>(block)]);
    }
    for (std::size_t i = 0; i < layout_.cuts.size(); ++i)
      if (layout_.cuts[i].from_host == host_ && inside(from(layout_.cuts[i]).block)) add_end(static_cast<int>(i), true);
  }

  void add_end(int index, bool sends) {
    const Cut& cut = layout_.cuts[static_cast<std::size_t>(index)];
    end_[static_cast<std::size_t>(index)] = static_cast<int>(part_.phase.blocks.size());
    part_.ends.push_back({end_[static_cast<std::size_t>(index)], index, sends});
    graph::Block block;
    block.type = cut.message ? (sends ? &record_outlet() : &record_inlet()) : (sends ? &sample_outlet() : &sample_inlet());
    const std::string& other = sends ? cut.to_host : cut.from_host;
    block.name = fmt::format("{} ({} {})", cut.name, sends ? "to" : "from", other.empty() ? "the launcher" : other);
    block.host = host_;
    part_.phase.blocks.push_back(std::move(block));
    part_.facts.blocks.push_back(cut.message ? (sends ? plan::Facts::Block{} : clock_facts()) : stream_facts(cut, sends));
  }

  /// A block that fires once a period until the run's end.
  plan::Facts::Block clock_facts() const {
    plan::Facts::Block block;
    block.outputs.resize(1);
    block.output_flows.resize(1);
    StreamFacts& tick = block.outputs.front();
    tick.known = true;
    tick.channels = 1;
    tick.rate = plan::divide(Rate{1, 1}, part_.facts.period).value_or(Rate{});
    block.firing_rate = tick.rate;
    block.repetitions = 1;
    block.firings = facts_.period.num == 0 ? 1 : plan::covering_firings(layout_.end, tick.rate);
    tick.length = block.firings;
    return block;
  }

  /// A block that fires once a sample.
  plan::Facts::Block stream_facts(const Cut& cut, bool sends) const {
    const plan::Facts::Block& producer = facts_.blocks[static_cast<std::size_t>(from(cut).block)];
    plan::Facts::Block block;
    (sends ? block.inputs : block.outputs).push_back(cut.facts);
    (sends ? block.input_flows : block.output_flows).push_back({});
    block.firing_rate = cut.facts.rate;
    block.repetitions = producer.repetitions * producer.output_flows[static_cast<std::size_t>(from(cut).port)].samples;
    block.firings = cut.facts.length;
    return block;
  }

  void add_streams() {
    for (std::size_t i = 0; i < phase_.streams.size(); ++i) {
      const graph::StreamEdge& edge = phase_.streams[i];
      if (mine(edge.from.block) && mine(edge.to.block)) {
        part_.phase.streams.push_back({local(edge.from), local(edge.to), edge.place});
      } else if (mine(edge.from.block)) {
        part_.phase.streams.push_back({local(edge.from), {end_of(false, i), 0}, edge.place});
      } else if (mine(edge.to.block)) {
        part_.phase.streams.push_back({{end_of(false, i), 0}, local(edge.to), edge.place});
        // The inlet gives the samples before the first real one itself.
        part_.facts.blocks[static_cast<std::size_t>(local(edge.to.block))]
            .input_flows[static_cast<std::size_t>(edge.to.port)]
            .delay = 0;
        part_.facts.blocks[static_cast<std::size_t>(local(edge.to.block))]
            .input_flows[static_cast<std::size_t>(edge.to.port)]
            .initial.clear();
      }
    }
  }

  void add_messages() {
    for (std::size_t i = 0; i < phase_.messages.size(); ++i) {
      const graph::MessageEdge& edge = phase_.messages[i];
      if (mine(edge.from.block) && mine(edge.to.block))
        part_.phase.messages.push_back({local(edge.from), local(edge.to), edge.latency, edge.place});
      else if (mine(edge.from.block))
        part_.phase.messages.push_back({local(edge.from), {end_of(true, i), 0}, {}, edge.place});
      else if (mine(edge.to.block))
        part_.phase.messages.push_back({{end_of(true, i), 0}, local(edge.to), {}, edge.place});
    }
  }

  void add_rest() {
    for (graph::Reference reference : phase_.references)
      if (mine(reference.to.block)) {
        reference.to = local(reference.to);
        part_.phase.references.push_back(reference);
      }
    for (graph::ScheduledChange change : phase_.schedule)
      if (mine(change.block)) {
        change.block = local(change.block);
        part_.phase.schedule.push_back(change);
      }
    for (graph::Limit limit : phase_.limits)
      if (mine(limit.port.block)) {
        limit.port = local(limit.port);
        part_.phase.limits.push_back(std::move(limit));
      }
    for (graph::RecordedPort recorded : phase_.recorded)
      if (mine(recorded.port.block)) {
        recorded.port = local(recorded.port);
        part_.phase.recorded.push_back(recorded);
      }
  }

  int end_of(bool message, std::size_t edge) const {
    for (std::size_t i = 0; i < layout_.cuts.size(); ++i)
      if (layout_.cuts[i].message == message && layout_.cuts[i].edge == static_cast<int>(edge)) return end_[i];
    return -1;
  }

  const graph::Phase& phase_;
  const plan::Facts& facts_;
  const Layout& layout_;
  const std::string& host_;
  std::vector<int> local_;  ///< by block of the whole phase: its index here, or -1
  std::vector<int> end_;    ///< by cut: the index of its end here, or -1
  Part part_;
};

}  // namespace

Part part_of(const graph::Phase& phase, const plan::Facts& facts, const Layout& layout, const std::string& host,
             const plan::PlanOptions& options) {
  return Parting(phase, facts, layout, host).run(options);
}

}  // namespace bodeflow::lab
