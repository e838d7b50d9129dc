#include "plan/loops.hpp"

#include <algorithm>

#include "plan/exact.hpp"
#include "plan/loop_model.hpp"
#include "plan/loop_simulation.hpp"
#include "plan/order.hpp"

namespace bodeflow::plan {
namespace {

/// The order of the blocks in which each makes all its firings of `periods` at once, or an empty list where that can't be.
std::vector<int> block_order(const LoopModel& model, std::int64_t periods) {
  std::vector<Arc> arcs;
  for (const LoopLink& link : model.links) {
    if (model.lead(link, periods) < periods) arcs.emplace_back(link.from, link.to);
  }
  const int nodes = static_cast<int>(model.blocks.size());
  std::vector<int> order = topological_order(nodes, arcs);
  if (static_cast<int>(order.size()) < nodes) order.clear();
  return order;
}

/// The most periods up to `most` for which there is such an order; 0: not even for one.
std::int64_t longest_pass(const LoopModel& model, std::int64_t most) {
  std::int64_t good = 0, bad = most + 1;
  while (bad - good > 1) {
    const std::int64_t middle = good + (bad - good) / 2;
    (block_order(model, middle).empty() ? bad : good) = middle;
  }
  return good;
}

}  // namespace

tl::expected<LoopSchedule, Problems> schedule_loop(const graph::Phase& phase, const Facts& facts, const std::vector<int>& blocks,
                                                   const std::vector<Link>& links, std::int64_t most) {
  const LoopModel model = loop_model(facts, blocks, links);
  LoopSchedule schedule;
  schedule.parts = model.parts;
  schedule.repetitions = longest_pass(model, static_cast<std::int64_t>(std::min<Wide>(Wide{most} * model.parts, Wide{1} << 40)));
  if (schedule.repetitions > 0) {
    for (const int node : block_order(model, schedule.repetitions)) {
      const std::int64_t count = model.has_streams[node] ? model.firings[node] * schedule.repetitions : 0;
      schedule.firings.push_back({model.blocks[node], count});
    }
    return schedule;
  }
  schedule.repetitions = 1;
  auto simulated = simulate_period(phase, model);
  if (!simulated) return tl::unexpected(std::move(simulated.error()));
  schedule.firings = std::move(*simulated);
  return schedule;
}

}  // namespace bodeflow::plan
