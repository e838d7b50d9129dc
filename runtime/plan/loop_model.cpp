#include "plan/loop_model.hpp"

#include <algorithm>
#include <numeric>

#include "plan/exact.hpp"

namespace bodeflow::plan {
namespace {

/// Most turns a period for the blocks without streams.
constexpr std::int64_t kFinestGrid = std::int64_t{1} << 22;

/// The latency of a message link in periods of the loop.
Rate periods_of(const Rate& latency, const Facts& facts, std::int64_t parts) {
  if (latency.num == 0) return {};
  // A phase without streams has no period: any latency orders the blocks.
  if (facts.period.num == 0) return {1, 1};
  const auto periods = divide(latency, facts.period);
  const auto inside = periods ? multiply(*periods, Rate{parts, 1}) : std::nullopt;
  return inside.value_or(Rate{std::int64_t{1} << 40, 1});  // beyond 64 bits: longer than any run
}

/// Turns a period of the blocks without streams: often enough that every firing of the others falls on a turn, and that a
/// latency after such a block lasts at least one turn.
std::int64_t turns(const LoopModel& model) {
  Wide grid = 1;
  std::int64_t fastest = 1;
  for (const std::int64_t count : model.firings) {
    if (count == 0) continue;
    fastest = std::max(fastest, count);
    grid = grid / greatest_common_divisor(grid, count) * count;
    if (grid > kFinestGrid) grid = fastest;
  }
  for (const LoopLink& link : model.links) {
    if (!link.link->message || model.has_streams[link.from] || link.latency.num == 0) continue;
    const Wide finer = ceil_divide(link.latency.den, Wide{link.latency.num} * grid);
    if (finer > 1 && finer * grid <= kFinestGrid) grid *= finer;
  }
  return static_cast<std::int64_t>(grid);
}

}  // namespace

std::int64_t LoopModel::needed(const LoopLink& link, std::int64_t index) const {
  // Firing i of the consumer is at the time i / consumer (in periods) and takes records up to `latency` before that. A stream
  // block's firing n can give records from n / producer on; a block without streams has dealt with all up to that time.
  const std::int64_t producer = firings[link.from], consumer = firings[link.to];
  const Wide num = (Wide{index} * link.latency.den - Wide{link.latency.num} * consumer) * producer;
  const Wide den = Wide{consumer} * link.latency.den;
  if (num < 0) return 0;
  const Wide last = has_streams[link.from] ? floor_divide(num, den) : ceil_divide(num, den);
  return static_cast<std::int64_t>(std::min<Wide>(last + 1, producer));
}

std::int64_t LoopModel::lead(const LoopLink& link, std::int64_t most) const {
  const Wide periods = link.link->message ? floor_divide(link.latency.num, link.latency.den)
                                          : floor_divide(link.link->delay, Wide{firings[link.to]} * link.link->consumed);
  return static_cast<std::int64_t>(std::min<Wide>(periods, most));
}

LoopModel loop_model(const Facts& facts, const std::vector<int>& blocks, const std::vector<Link>& links) {
  LoopModel model;
  model.blocks = blocks;
  std::vector<int> local(facts.blocks.size(), -1);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    local[blocks[i]] = static_cast<int>(i);
    model.firings.push_back(facts.blocks[blocks[i]].repetitions);
    model.has_streams.push_back(model.firings.back() > 0);
  }
  model.parts = 0;
  for (const std::int64_t count : model.firings) model.parts = std::gcd(count, model.parts);
  model.parts = std::max<std::int64_t>(model.parts, 1);
  for (std::int64_t& count : model.firings) count /= model.parts;

  for (const Link& link : links) {
    if (local[link.from] < 0 || local[link.to] < 0) continue;
    LoopLink inside;
    inside.from = local[link.from];
    inside.to = local[link.to];
    inside.link = &link;
    if (link.message) inside.latency = periods_of(link.latency, facts, model.parts);
    model.links.push_back(inside);
  }
  const std::int64_t grid = turns(model);
  for (std::int64_t& count : model.firings) count = count == 0 ? grid : count;
  return model;
}

}  // namespace bodeflow::plan
