// How a block takes records and changes.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "execute/access.hpp"
#include "execute/change.hpp"
#include "execute/run.hpp"

namespace bodeflow::execute {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time until its end to a block's seconds beside its firings.
class Stopwatch {
 public:
  explicit Stopwatch(BlockRun& block) : block_(block), on_(block.run->options.metrics) {
    if (on_) begin_ = Clock::now();
  }
  ~Stopwatch() {
    if (on_) block_.other_s += std::chrono::duration<double>(Clock::now() - begin_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  BlockRun& block_;
  bool on_;
  Clock::time_point begin_;
};

void drop_messages(BlockRun& block) {
  block.process.message_count = 0;
  block.messages.clear();
  block.held.clear();
}

void show_messages(BlockRun& block) {
  block.process.message_count = static_cast<std::uint32_t>(block.messages.size());
  block.process.messages = block.messages.data();
}

void hold(BlockRun& block, Entry& entry) {
  block.messages.push_back({static_cast<std::uint32_t>(entry.port), 0, entry.made_s, entry.record.c()});
  block.held.push_back(std::move(entry.record));
}

/// A call without firings: process for the held messages, or finish.
bool call_empty(BlockRun& block, std::int32_t (*function)(void*, bf_process*), const char* name, Lane& lane) {
  if (function == nullptr) return true;
  const Stopwatch stopwatch(block);
  set_count(block, 0);
  block.process.count = 0;
  block.process.position = static_cast<std::uint64_t>(block.position);
  block.process.done = 0;
  show_messages(block);
  lane.function(name);
  lane.call(block.index);
  ++block.calls;
  const std::int32_t status = function(block.self, &block.process);
  lane.function("process");
  const bool fine = status == BF_OK && !block.fault && block.process.done == 0 && !block.control->stopping();
  const bool go_on = fine || settle(block, status);
  drop_messages(block);
  return go_on;
}

Instance::Result change(BlockRun& block, int parameter, const ParameterValue& value, Lane& lane) {
  const Stopwatch stopwatch(block);
  lane.function("change");
  lane.call(block.index);
  auto changed = block.instance->change(static_cast<std::uint32_t>(parameter), value);
  lane.function("process");
  return changed;
}

void changed(BlockRun& block, int parameter, const ParameterValue& value, std::int64_t position, Cause cause) {
  if (!block.values.empty()) block.values[static_cast<std::size_t>(parameter)] = value;
  block.run->sink->changed(block.index, parameter, value, static_cast<std::uint64_t>(position), cause);
}

bool apply(BlockRun& block, int parameter, const ParameterValue& value, std::int64_t position, Cause cause, Lane& lane) {
  const auto done = change(block, parameter, value, lane);
  if (block.control->stopping()) return false;
  if (!done) {
    block.run->control.fail(block.index, done.error());
    return false;
  }
  changed(block, parameter, value, position, cause);
  return true;
}

/// A person who asks for what the block refuses is told so, and the block keeps the value that it has: no end of the run.
bool apply_asked(BlockRun& block, const Entry& entry, std::int64_t position, Lane& lane) {
  Asked& asked = *entry.asked;
  const auto done = change(block, entry.parameter, asked.value, lane);
  if (block.control->stopping()) return false;
  if (done) {
    changed(block, entry.parameter, asked.value, position, Cause::live);
    asked.position.store(position, std::memory_order_release);
    return true;
  }
  asked.refusal = done.error();
  asked.position.store(Asked::kRefused, std::memory_order_release);
  const auto back = change(block, entry.parameter, block.values[static_cast<std::size_t>(entry.parameter)], lane);
  if (!back) block.run->control.fail(block.index, back.error());
  return !block.control->stopping();
}

bool take_change(BlockRun& block, const Entry& entry, Lane& lane) {
  const std::int64_t position = entry.live && !block.has_streams() ? entry.due : block.position;
  if (entry.asked != nullptr) return apply_asked(block, entry, position, lane);
  if (entry.kind == Entry::Kind::change)
    return apply(block, entry.parameter, *entry.value, position, entry.live ? Cause::live : Cause::schedule, lane);
  const auto change = parameter_change(block.instance->type(), RecordView(*entry.record.c()));
  if (!change) {
    block.run->control.fail(block.index, change.error());
    return false;
  }
  return apply(block, change->parameter, change->value, position, Cause::record, lane);
}

bool is_change(const Entry& entry) {
  return entry.kind == Entry::Kind::change || (entry.kind == Entry::Kind::record && entry.port == graph::kParameterPort);
}

bool await_answer(BlockRun& block, const Entry& barrier, Lane& lane) {
  Run& run = *block.run;
  Worker& worker = *run.workers[static_cast<std::size_t>(barrier.worker)];
  if (run.realtime() && !worker.done(barrier.job)) {
    run.overruns.fetch_add(1, std::memory_order_relaxed);
    if (run.phase->run.on_overrun == graph::Overrun::stop) {
      run.control.fail(worker.block().index, "its answer came late, and on_overrun is 'stop'");
      return false;
    }
  }
  if (!worker.wait(barrier.job, block.index, lane)) return false;
  block.inbox.collect();
  return true;
}

bool too_late(BlockRun& block, const Entry& entry) {
  if (entry.due >= block.position || entry.edge < 0) return false;
  block.run->control.fail(
      block.index, fmt::format("plan: a record for firing {} came after firing {} was made", entry.due, block.position - 1));
  return true;
}

/// Takes what is due before firing `position`; messages are held for the coming call.
bool gather(BlockRun& block, Lane& lane) {
  while (block.inbox.next_due() <= block.position) {
    Entry entry = block.inbox.pop();
    if (entry.kind == Entry::Kind::barrier) {
      if (!await_answer(block, entry, lane)) return false;
      continue;
    }
    if (too_late(block, entry)) return false;
    if (is_change(entry)) {
      // Messages before it are taken before it.
      if (!block.messages.empty() && !call_empty(block, block.call, "process", lane)) return false;
      if (!take_change(block, entry, lane)) return false;
    } else {
      hold(block, entry);
    }
  }
  return true;
}

/// An asynchronous block's worker gets the entry; whoever takes its answer will wait for it.
void hand_over(BlockRun& block, Entry entry) {
  Run& run = *block.run;
  Entry barrier;
  barrier.kind = Entry::Kind::barrier;
  barrier.worker = block.worker;
  const Time time = entry.time;
  const bool answers = !is_change(entry);
  barrier.job = run.workers[static_cast<std::size_t>(block.worker)]->hand(std::move(entry));
  if (!answers) return;
  for (const auto& routes : block.routes) {
    for (const Route& route : routes) {
      BlockRun& to = run.block(route.to);
      barrier.edge = route.edge;
      barrier.time = later(time, route.latency);
      barrier.due = to.has_streams() ? first_firing(barrier.time, to.rate) : 0;
      if (to.partition == block.partition)
        to.inbox.add(barrier);
      else
        to.inbox.send(barrier);
    }
  }
}

Horizon earlier(const Horizon& a, const Horizon& b) {
  if (a.endless) return b;
  if (b.endless) return a;
  return b.time < a.time ? b : a;
}

/// Up to which time no more records can come from `origin`.
Horizon horizon_of(BlockRun& block, const Origin& origin, const Chunk& chunk) {
  Run& run = *block.run;
  BlockRun& from = run.block(origin.block);
  Horizon horizon;
  if (from.has_streams()) {
    const std::int64_t end = from.end.load(std::memory_order_relaxed);
    if (origin.remote) {
      const std::int64_t periods = run.chunking.end(chunk.index - origin.lag);
      horizon = {static_cast<__int128>(periods) * from.per_repetition >= end, run.time_of_period(periods)};
    } else {
      horizon = {from.position >= end, time_of(from.position, from.rate)};
    }
    if (from.remote != nullptr && !from.remote->silent()) horizon.endless = false;
  } else {
    horizon = origin.remote ? block.inbox.announced(origin.edge) : from.horizon;
  }
  if (!horizon.endless) horizon.time = later(horizon.time, origin.latency);
  return horizon;
}

void announce(BlockRun& block) {
  for (const auto& routes : block.routes)
    for (const Route& route : routes)
      if (route.horizon) block.run->block(route.to).inbox.announce(route.edge, block.horizon);
}

}  // namespace

bool fire_to(BlockRun& block, std::int64_t end, Lane& lane) {
  const std::int64_t most = block.run->options.call_limit > 0 ? block.run->options.call_limit : kNever;
  while (block.position < end) {
    std::int64_t stop = end;
    if (block.takes_messages) {
      if (!gather(block, lane)) return false;
      stop = std::min(stop, block.inbox.next_due());
    }
    stop = std::min(stop, most > end - block.position ? end : block.position + most);
    show_messages(block);
    const bool go_on = fire(block, stop - block.position, lane);
    drop_messages(block);
    if (!go_on) return false;
    if (block.position < stop) break;  // a source ended
  }
  return true;
}

bool take_alone(BlockRun& block, Entry entry, Lane& lane) {
  block.now = entry.time;
  if (is_change(entry)) return take_change(block, entry, lane);
  hold(block, entry);
  return call_empty(block, block.call, "process", lane);
}

bool take_turn(BlockRun& block, const Chunk& chunk, Lane& lane) {
  // What is announced is read before what was sent is brought in: all records before the horizon are there then.
  Horizon horizon{true, {}};
  for (const Origin& origin : block.origins) horizon = earlier(horizon, horizon_of(block, origin, chunk));
  block.inbox.collect();
  if (block.asked.load(std::memory_order_relaxed) != nullptr) take_asked_before(block, horizon);
  while (!block.inbox.empty() && horizon.beyond(block.inbox.front().time)) {
    // Changes after the last record may lie beyond the end of the run.
    if (horizon.endless && !block.inbox.has_records()) break;
    Entry entry = block.inbox.pop();
    if (entry.kind == Entry::Kind::barrier) {
      if (!await_answer(block, entry, lane)) return false;
    } else if (block.worker >= 0) {
      hand_over(block, std::move(entry));
    } else if (!take_alone(block, std::move(entry), lane)) {
      return false;
    }
  }
  block.horizon = horizon;
  announce(block);
  return block.remote == nullptr || block.remote->reached(block, horizon, lane);
}

bool take_rest(BlockRun& block, const Time& end, Lane& lane) {
  block.inbox.collect();
  while (!block.inbox.empty()) {
    Entry entry = block.inbox.pop();
    if (entry.kind == Entry::Kind::barrier) {
      if (!await_answer(block, entry, lane)) return false;
    } else if (block.has_streams()) {
      if (!is_change(entry)) hold(block, entry);
    } else {
      const bool gone = entry.kind == Entry::Kind::change && !block.inbox.has_records() && end < entry.time;
      if (!gone && !take_alone(block, std::move(entry), lane)) return false;
    }
  }
  return block.messages.empty() || call_empty(block, block.call, "process", lane);
}

bool finish(BlockRun& block, Lane& lane) { return call_empty(block, block.instance->c().finish, "finish", lane); }

}  // namespace bodeflow::execute
