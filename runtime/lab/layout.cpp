// Which connections leave a host, in what order all hosts work, how long a chunk may be.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lab/split.hpp"
#include "plan/exact.hpp"
#include "plan/links.hpp"
#include "plan/names.hpp"
#include "plan/order.hpp"

namespace bodeflow::lab {
namespace {

using plan::Arc;
using plan::Link;
using plan::Wide;

class LayingOut {
 public:
  LayingOut(const graph::Phase& phase, const plan::Facts& facts, std::vector<Link> links)
      : phase_(phase), facts_(facts), links_(std::move(links)), loop_(phase.blocks.size(), -1) {
    std::vector<Arc> arcs;
    for (const Link& link : links_) arcs.emplace_back(link.from, link.to);
    int count = 0;
    for (const plan::Component& component : plan::ordered_components(static_cast<int>(phase.blocks.size()), arcs)) {
      if (component.loop)
        for (const int block : component.nodes) loop_[static_cast<std::size_t>(block)] = count;
      ++count;
    }
  }

  tl::expected<Layout, Problems> run(std::int64_t most_periods) {
    name_hosts();
    for (const std::int64_t periods : candidates(most_periods)) {
      auto steps = components(periods);
      if (over_hosts(steps) != nullptr) continue;
      layout_.periods = periods;
      layout_.steps = std::move(steps);
      add_cuts();
      layout_.end = end();
      if (auto problem = restart_problem()) return tl::unexpected(Problems{*problem});
      return std::move(layout_);
    }
    return tl::unexpected(Problems{loop_problem()});
  }

 private:
  const std::string& host(int block) const { return phase_.blocks[static_cast<std::size_t>(block)].host; }
  bool crosses(const Link& link) const { return host(link.from) != host(link.to); }

  void name_hosts() {
    for (const graph::Block& block : phase_.blocks)
      if (std::find(layout_.hosts.begin(), layout_.hosts.end(), block.host) == layout_.hosts.end())
        layout_.hosts.push_back(block.host);
  }

  /// Whole periods of the phase that the consumer of a link may be ahead of its producer.
  std::int64_t lead(const Link& link) const {
    if (facts_.period.num == 0) return 0;
    if (link.message)
      return static_cast<std::int64_t>(
          plan::floor_divide(Wide{link.latency.num} * facts_.period.den, Wide{link.latency.den} * facts_.period.num));
    const plan::Facts::Block& from = facts_.blocks[static_cast<std::size_t>(link.from)];
    return link.delay / std::max<std::int64_t>(1, from.repetitions * link.produced);
  }

  /// Chunks to try: the wished one, then the leads of the links between hosts, falling.
  std::vector<std::int64_t> candidates(std::int64_t most) const {
    std::set<std::int64_t, std::greater<>> all{most};
    for (const Link& link : links_)
      if (crosses(link) && in_loop(link) && lead(link) >= 1 && lead(link) < most) all.insert(lead(link));
    return {all.begin(), all.end()};
  }

  bool in_loop(const Link& link) const {
    const int loop = loop_[static_cast<std::size_t>(link.from)];
    return loop >= 0 && loop == loop_[static_cast<std::size_t>(link.to)];
  }

  /// Whether the consumer runs ahead of the producer, in chunks of `periods`.
  bool loose(const Link& link, std::int64_t periods) const { return crosses(link) && in_loop(link) && lead(link) >= periods; }

  std::vector<std::vector<int>> components(std::int64_t periods) const {
    std::vector<Arc> arcs;
    for (const Link& link : links_)
      if (!loose(link, periods)) arcs.emplace_back(link.from, link.to);
    std::vector<std::vector<int>> steps;
    for (plan::Component& component : plan::ordered_components(static_cast<int>(phase_.blocks.size()), arcs))
      steps.push_back(std::move(component.nodes));
    return steps;
  }

  /// A component with blocks of more than one host, or null.
  const std::vector<int>* over_hosts(const std::vector<std::vector<int>>& steps) const {
    for (const auto& step : steps)
      for (const int block : step)
        if (host(block) != host(step.front())) return &step;
    return nullptr;
  }

  Problem loop_problem() const {
    const auto steps = components(1);
    std::string names;
    for (const int block : *over_hosts(steps))
      names += fmt::format("{}'{}'{}", names.empty() ? "" : ", ", phase_.blocks[static_cast<std::size_t>(block)].name,
                           host(block).empty() ? "" : " on " + host(block));
    return {phase_.blocks[static_cast<std::size_t>(over_hosts(steps)->front())].place,
            fmt::format(
                "the loop of {} goes over hosts: one of its connections between hosts needs a delay of at least one period of "
                "the graph, {}; write it there (a delay in front of the consumer, or a latency of a record)",
                names, plan::seconds_text(facts_.period.hz()))};
  }

  /// What a part can't be started again with.
  std::optional<Problem> restart_problem() const {
    if (!phase_.run.restart) return {};
    for (const Cut& cut : layout_.cuts) {
      if (cut.message)
        return Problem{phase_.messages[static_cast<std::size_t>(cut.edge)].place,
                       fmt::format("run: restart: records go over hosts from {}: those that a lost host did not send can't be "
                                   "told; put both blocks on one host, or take 'restart' away",
                                   cut.name)};
      if (cut.ahead && phase_.run.gaps == graph::Gaps::nan)
        return Problem{phase_.streams[static_cast<std::size_t>(cut.edge)].place,
                       fmt::format("run: restart: {} closes a loop over hosts, in which samples that are no number never end; "
                                   "'gaps: hold' repeats the last one in place of those that are missing",
                                   cut.name)};
    }
    return {};
  }

  void add_cuts() {
    for (const Link& link : links_) {
      if (!crosses(link)) continue;
      Cut cut;
      cut.from_host = host(link.from);
      cut.to_host = host(link.to);
      cut.name = plan::connection(phase_, link);
      cut.message = link.message;
      cut.edge = link.edge;
      cut.ahead = loose(link, layout_.periods);
      if (link.message)
        describe_records(link, cut);
      else
        describe_stream(link, cut);
      layout_.cuts.push_back(std::move(cut));
    }
  }

  void describe_stream(const Link& link, Cut& cut) const {
    const graph::StreamEdge& edge = phase_.streams[static_cast<std::size_t>(link.edge)];
    const plan::Facts::Block& to = facts_.blocks[static_cast<std::size_t>(link.to)];
    cut.facts = facts_.blocks[static_cast<std::size_t>(link.from)].outputs[static_cast<std::size_t>(edge.from.port)];
    const Flow& flow = to.input_flows[static_cast<std::size_t>(edge.to.port)];
    cut.delay = flow.delay;
    cut.initial = flow.initial;
    cut.gaps = phase_.run.gaps;
  }

  void describe_records(const Link& link, Cut& cut) const {
    const graph::MessageEdge& edge = phase_.messages[static_cast<std::size_t>(link.edge)];
    cut.latency = link.latency;
    cut.record_type =
        phase_.blocks[static_cast<std::size_t>(link.from)].type->port_at(BF_MESSAGE, BF_OUT, edge.from.port).record_type;
  }

  Rate end() const {
    Rate latest;
    for (const plan::Facts::Block& block : facts_.blocks) {
      if (block.repetitions == 0 || block.firings < 0) continue;
      const Rate mine = plan::divide(Rate{block.firings, 1}, block.firing_rate).value_or(Rate{});
      if (plan::less(latest, mine)) latest = mine;
    }
    return latest;
  }

  const graph::Phase& phase_;
  const plan::Facts& facts_;
  std::vector<Link> links_;
  std::vector<int> loop_;  ///< by block: which loop of the whole phase it is in, or -1
  Layout layout_;
};

/// A host ends when it hears of a violation on another one: no plan tells when that is.
Problems limits_over_hosts(const graph::Phase& phase) {
  Problems problems;
  for (const graph::Limit& limit : phase.limits) {
    const graph::Block& watched = phase.blocks[static_cast<std::size_t>(limit.port.block)];
    if (limit.input || !limit.time_s || limit.on_violation != graph::OnViolation::stop) continue;
    for (const graph::Block& block : phase.blocks)
      if (block.type->has_role("device") && block.host != watched.host) {
        problems.push_back(
            {limit.time_place,
             fmt::format("limits: '{}' must act within {}, but block '{}' is on another host, which hears of it over "
                         "the network in no stated time; allowed: both on one host, or no 'time'",
                         plan::stream_output(phase, limit.port), plan::seconds_text(*limit.time_s), block.name)});
        break;
      }
  }
  return problems;
}

}  // namespace

tl::expected<Layout, Problems> lay_out(const graph::Phase& phase, const plan::Facts& facts, const plan::PlanOptions& options) {
  if (Problems problems = limits_over_hosts(phase); !problems.empty()) return tl::unexpected(std::move(problems));
  auto links = plan::links_of(phase, facts);
  if (!links) return tl::unexpected(links.error());
  const std::int64_t most = plan::periods_in_chunk(facts, options, 1);
  if (most < 1)
    return tl::unexpected(
        Problems{{phase.place, fmt::format("run.latency is shorter than the common period of all sample rates, {}",
                                           plan::seconds_text(facts.period.hz()))}});
  return LayingOut(phase, facts, std::move(*links)).run(most);
}

}  // namespace bodeflow::lab
