// How changes that were asked for from outside get in front of a block.
#include <utility>

#include "execute/access.hpp"
#include "execute/run.hpp"

namespace bodeflow::execute {
namespace {

/// Puts the changes that were asked for from outside into the block's inbox, in the order in which they were.
void add_asked(BlockRun& block, std::int64_t due, const Time& time) {
  Asked* first = nullptr;
  for (Asked* asked = block.asked.exchange(nullptr, std::memory_order_acquire); asked != nullptr;) {
    Asked* before = asked->next;
    asked->next = first;
    first = asked;
    asked = before;
  }
  const auto others = static_cast<std::int64_t>(block.run->schedule.size() + block.run->options.past_changes.size());
  for (Asked* asked = first; asked != nullptr; asked = asked->next) {
    Entry entry;
    entry.kind = Entry::Kind::change;
    entry.due = due;
    entry.time = time;
    entry.edge = kScheduleEdge;
    entry.sequence = others + block.changes_taken++;
    entry.parameter = asked->parameter;
    entry.live = true;
    entry.asked = asked;
    block.inbox.add(std::move(entry));
  }
}

}  // namespace

void take_asked(BlockRun& block) { add_asked(block, block.position, time_of(block.position, block.rate)); }

void take_asked_before(BlockRun& block, const Horizon& horizon) {
  const Rate& period = block.run->period;
  if (horizon.endless || period.num == 0) return;
  const std::int64_t count = first_firing(horizon.time, Rate(period.den, period.num));
  add_asked(block, count, block.run->time_of_period(count));
}

}  // namespace bodeflow::execute
