#include "plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plan/exact.hpp"
#include "plan/loops.hpp"
#include "plan/memory.hpp"
#include "plan/names.hpp"
#include "plan/order.hpp"
#include "plan/partitions.hpp"

namespace bodeflow::plan {
namespace {

/// Declared work of a thread in one chunk below which handing over to it costs more than it brings.
constexpr double kLeastWork_ns = 20000.0;

/// How often and in how many pieces a phase is worked on.
struct Division {
  std::int64_t repetitions = 1;  ///< periods in a chunk
  std::vector<int> starts{0};    ///< index of the first component of each partition
};

/// Samples of the fastest stream in one period of the phase.
std::int64_t most_samples(const Facts& facts) {
  std::int64_t most = 1;
  for (const Facts::Block& block : facts.blocks) {
    for (const Flow& flow : block.input_flows) most = std::max(most, block.repetitions * flow.samples);
    for (const Flow& flow : block.output_flows) most = std::max(most, block.repetitions * flow.samples);
  }
  return most;
}

class Planner {
 public:
  Planner(const graph::Phase& phase, const Facts& facts, const PlanOptions& options)
      : phase_(phase), facts_(facts), options_(options), count_(static_cast<int>(phase.blocks.size())) {}

  tl::expected<Plan, Problems> run() {
    auto links = links_of(phase_, facts_);
    if (!links) return tl::unexpected(std::move(links.error()));
    links_ = std::move(*links);
    std::vector<Arc> arcs;
    for (const Link& link : links_) arcs.emplace_back(link.from, link.to);
    components_ = ordered_components(count_, arcs);
    if (auto divided = divide(); !divided) return tl::unexpected(std::move(divided.error()));
    if (auto scheduled = make_steps(); !scheduled) return tl::unexpected(std::move(scheduled.error()));
    place_buffers(phase_, buffers_, options_.kept, plan_);
    finish();
    auto limits = limits_of(phase_, facts_, plan_);
    if (!limits) return tl::unexpected(std::move(limits.error()));
    plan_.limits = std::move(*limits);
    return std::move(plan_);
  }

 private:
  double cost_of(const Component& component) const {
    double cost = 0.0;
    for (const int block : component.nodes) {
      cost += static_cast<double>(facts_.blocks[block].repetitions) * phase_.blocks[block].type->cost_ns;
    }
    return cost;
  }

  /// Chooses chunk and threads: as many threads as asked for, as long as each has enough to do.
  tl::expected<void, Problems> divide() {
    if (periods_in_chunk(facts_, options_, 1) < 1) {
      return tl::unexpected(Problems{{phase_.place, "run.latency " + seconds_text(*options_.latency_s) +
                                                        " is shorter than the common period of all sample rates, " +
                                                        seconds_text(facts_.period.hz())}});
    }
    std::vector<double> costs;
    double total = 0.0;
    for (const Component& component : components_) {
      costs.push_back(cost_of(component));
      total += costs.back();
    }
    const int most = std::max(1, std::min(options_.threads, static_cast<int>(components_.size())));
    for (int threads = most; threads >= 1; --threads) {
      const std::int64_t repetitions = periods_in_chunk(facts_, options_, threads);
      if (repetitions < 1) continue;
      const double least = threads == 1 ? 0.0 : kLeastWork_ns / static_cast<double>(repetitions);
      const std::vector<int> starts = cut(costs, threads, least);
      if (starts.empty()) continue;
      division_ = {repetitions, starts};
      break;
    }
    plan_.repetitions = division_.repetitions;
    const int threads = static_cast<int>(division_.starts.size());
    if (threads < options_.threads) {
      plan_.notes.push_back(
          fmt::format("{} of {} threads used: no cut into more gives each at least {} of declared work a chunk ({} in all)",
                      threads, options_.threads, seconds_text(kLeastWork_ns * 1e-9),
                      seconds_text(total * static_cast<double>(division_.repetitions) * 1e-9)));
    }
    return {};
  }

  static Step call(int block) {
    Step step;
    step.block = block;
    return step;
  }

  /// One step a component, copies behind the component that writes.
  tl::expected<void, Problems> make_steps() {
    buffers_ = assign_buffers(phase_, facts_, plan_.repetitions);
    plan_.partitions.resize(division_.starts.size());
    plan_.partition_of.assign(count_, 0);
    Problems problems;
    int partition = 0;
    for (int index = 0; index < static_cast<int>(components_.size()); ++index) {
      const Component& component = components_[index];
      if (partition + 1 < static_cast<int>(division_.starts.size()) && index >= division_.starts[partition + 1]) ++partition;
      std::vector<Step>& steps = plan_.partitions[partition].steps;
      plan_.partitions[partition].cost_ns += cost_of(component);
      for (const int block : component.nodes) plan_.partition_of[block] = partition;
      if (component.loop) {
        auto step = loop_step(component);
        if (!step) {
          problems.insert(problems.end(), step.error().begin(), step.error().end());
          continue;
        }
        steps.push_back(std::move(*step));
      } else {
        plan_.order.push_back(component.nodes.front());
        steps.push_back(call(component.nodes.front()));
      }
      add_copies(component, steps);
    }
    if (!problems.empty()) return tl::unexpected(std::move(problems));
    return {};
  }

  tl::expected<Step, Problems> loop_step(const Component& component) {
    auto schedule = schedule_loop(phase_, facts_, component.nodes, links_, plan_.repetitions);
    if (!schedule) return tl::unexpected(std::move(schedule.error()));
    Step step;
    step.kind = Step::Kind::cluster;
    step.block = component.nodes.front();
    step.repetitions = schedule->repetitions;
    step.parts = schedule->parts;
    for (const Firing& firing : schedule->firings) {
      step.schedule.push_back(firing);
      for (const Copy& copy : buffers_.copies) {
        if (copy.block == firing.block && stays_inside(copy, component)) {
          step.schedule.push_back({firing.block, firing.count, copy.from, copy.to});
        }
      }
    }
    add_order(component);
    return step;
  }

  /// Finish runs through a loop along its edges without delay.
  void add_order(const Component& component) {
    std::vector<int> local(count_, -1);
    for (std::size_t i = 0; i < component.nodes.size(); ++i) local[component.nodes[i]] = static_cast<int>(i);
    std::vector<Arc> arcs;
    for (const Link& link : links_) {
      if (local[link.from] >= 0 && local[link.to] >= 0 && !link.loose()) arcs.emplace_back(local[link.from], local[link.to]);
    }
    for (const int node : topological_order(static_cast<int>(component.nodes.size()), arcs)) {
      plan_.order.push_back(component.nodes[node]);
    }
  }

  static bool contains(const Component& component, int block) {
    return std::binary_search(component.nodes.begin(), component.nodes.end(), block);
  }

  /// Whether a copy is read in the loop that writes it, so that it is part of the loop's schedule.
  static bool stays_inside(const Copy& copy, const Component& component) {
    return component.loop &&
           std::any_of(copy.readers.begin(), copy.readers.end(), [&](int block) { return contains(component, block); });
  }

  void add_copies(const Component& component, std::vector<Step>& steps) const {
    for (const Copy& copy : buffers_.copies) {
      if (!contains(component, copy.block) || stays_inside(copy, component)) continue;
      Step step;
      step.kind = Step::Kind::copy;
      step.block = copy.block;
      step.from_buffer = copy.from;
      step.to_buffer = copy.to;
      steps.push_back(step);
    }
  }

  void finish() {
    plan_.buffers = std::move(buffers_.all);
    plan_.inputs = std::move(buffers_.inputs);
    plan_.outputs = std::move(buffers_.outputs);
    plan_.initial = std::move(buffers_.initial);
    for (const Partition& partition : plan_.partitions) plan_.bytes += partition.arena_bytes;
    plan_.chunk_s = static_cast<double>(plan_.repetitions) * facts_.period.hz();
    plan_.latency_s = plan_.chunk_s * static_cast<double>(plan_.partitions.size());
  }

  const graph::Phase& phase_;
  const Facts& facts_;
  const PlanOptions& options_;
  int count_;
  std::vector<Link> links_;
  std::vector<Component> components_;
  Division division_;
  Buffers buffers_;
  Plan plan_;
};

}  // namespace

std::int64_t periods_in_chunk(const Facts& facts, const PlanOptions& options, int threads) {
  if (facts.period.num == 0) return 1;
  if (options.periods) return *options.periods;
  const std::int64_t by_chunk = std::max<std::int64_t>(1, options.chunk / most_samples(facts));
  if (!options.latency_s) return by_chunk;
  const Rate budget = Rate::from_hz(*options.latency_s);
  const Wide by_latency = floor_divide(Wide{budget.num} * facts.period.den, Wide{budget.den} * facts.period.num * threads);
  return static_cast<std::int64_t>(std::min<Wide>(by_chunk, by_latency));
}

tl::expected<Plan, Problems> make_plan(const graph::Phase& phase, const Facts& facts, const PlanOptions& options) {
  return Planner(phase, facts, options).run();
}

}  // namespace bodeflow::plan
