// The records' part of a plan: who sends what to whom, how far behind a thread may be, what stands at the start.
#include <fmt/format.h>

#include <algorithm>

#include "execute/compile.hpp"

namespace bodeflow::execute {
namespace {

using Failed = tl::unexpected<std::string>;

/// Chunks that a latency is long: the consumer's chunk k needs nothing of the producer's later than chunk k - lag.
std::int64_t lag_of(const Run& run, const Rate& latency) {
  if (run.period.num == 0 || latency.num == 0) return 0;
  const __int128 chunk_num = static_cast<__int128>(run.period.num) * run.chunking.periods;
  const __int128 lag = static_cast<__int128>(latency.num) * run.period.den / (chunk_num * latency.den);
  return static_cast<std::int64_t>(std::min<__int128>(lag, std::int64_t{1} << 40));
}

tl::expected<Rate, std::string> latency_of(const Run& run, const graph::MessageEdge& edge, const BlockRun& to) {
  if (edge.latency.samples == 0) return edge.latency.seconds;
  if (!to.has_streams())
    return Failed(fmt::format("a latency in samples needs a consumer with streams: block '{}' has none", run.name(to.index)));
  return Rate(edge.latency.samples * to.rate.den, to.rate.num);
}

tl::expected<void, std::string> add_edge(Run& run, int index) {
  const graph::MessageEdge& edge = run.phase->messages[static_cast<std::size_t>(index)];
  BlockRun &from = run.block(edge.from.block), &to = run.block(edge.to.block);
  const auto latency = latency_of(run, edge, to);
  if (!latency) return Failed(latency.error());
  const bool threads_apart = from.partition != to.partition;

  Route route;
  route.to = to.index;
  route.port = edge.to.port;
  route.latency = *latency;
  route.edge = index;
  route.remote = threads_apart || from.worker >= 0;
  route.horizon = threads_apart && !from.has_streams() && !to.has_streams();
  if (edge.to.port != graph::kParameterPort)
    route.type = to.instance->type().port_at(BF_MESSAGE, BF_IN, edge.to.port).record_type;
  from.routes[static_cast<std::size_t>(edge.from.port)].push_back(std::move(route));

  to.takes_messages = true;
  const std::int64_t lag = lag_of(run, *latency);
  if (!to.has_streams()) to.origins.push_back({from.index, index, *latency, threads_apart, lag});
  depend(run, from.index, op_of(*run.partitions[static_cast<std::size_t>(from.partition)], from.index), to.index,
         Lane::Wait::records, lag);
  return {};
}

void add_initial(Run& run, const std::vector<InitialRecord>& initial) {
  for (std::size_t i = 0; i < initial.size(); ++i) {
    Entry entry;
    entry.edge = kInitialEdge;
    entry.sequence = static_cast<std::int64_t>(i);
    entry.port = initial[i].to.port;
    entry.record = initial[i].record;
    BlockRun& to = run.block(initial[i].to.block);
    to.takes_messages = true;
    to.inbox.add(std::move(entry));
  }
}

void add_schedule(Run& run) {
  run.schedule = run.phase->schedule;
  for (std::size_t i = 0; i < run.schedule.size(); ++i) {
    const graph::ScheduledChange& change = run.schedule[i];
    BlockRun& to = run.block(change.block);
    Entry entry;
    entry.kind = Entry::Kind::change;
    // 0.1 in a graph means a tenth, not the double next to it: the simplest fraction is meant.
    const Rate at = Rate::from_hz(change.time_s);
    entry.time = {at.num, at.den};
    entry.due = to.has_streams() ? first_firing(entry.time, to.rate) : 0;
    entry.edge = kScheduleEdge;
    entry.sequence = static_cast<std::int64_t>(i);
    entry.parameter = change.parameter;
    entry.value = &change.value;
    to.takes_messages = true;
    to.inbox.add(std::move(entry));
  }
}

/// Changes that were made by hand in the run that is repeated.
void add_past_changes(Run& run) {
  const auto& changes = run.options.past_changes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    BlockRun& to = run.block(changes[i].block);
    Entry entry;
    entry.kind = Entry::Kind::change;
    entry.due = changes[i].position;
    entry.time = to.has_streams() ? time_of(entry.due, to.rate) : run.time_of_period(entry.due);
    entry.edge = kScheduleEdge;
    entry.sequence = static_cast<std::int64_t>(run.schedule.size() + i);
    entry.parameter = changes[i].parameter;
    entry.value = &changes[i].value;
    entry.live = true;
    to.takes_messages = true;
    to.inbox.add(std::move(entry));
  }
}

/// Blocks whose parameters an observer may change look for that at the start of each chunk.
void open_to_observer(Run& run) {
  if (run.options.observer == nullptr) return;
  for (const auto& block : run.blocks) {
    const auto& parameters = block->instance->type().parameters;
    if (std::none_of(parameters.begin(), parameters.end(), [](const auto& p) { return p.live; })) continue;
    block->takes_messages = true;
    block->values = run.phase->blocks[static_cast<std::size_t>(block->index)].parameters;
  }
}

}  // namespace

tl::expected<void, std::string> compile_messages(Run& run, const std::vector<InitialRecord>& initial) {
  for (const auto& block : run.blocks) {
    const BlockDescription& type = block->instance->type();
    const int outputs = type.count(BF_MESSAGE, BF_OUT);
    block->routes.resize(static_cast<std::size_t>(outputs));
    for (int port = 0; port < outputs; ++port) block->sends.push_back(type.port_at(BF_MESSAGE, BF_OUT, port).record_type);
    if (!type.asynchronous || block->has_streams()) continue;
    block->worker = static_cast<int>(run.workers.size());
    run.workers.push_back(std::make_unique<Worker>(*block, run.control));
    run.control.watch(run.workers.back()->work());
    run.control.watch(run.workers.back()->answers());
  }
  for (std::size_t i = 0; i < run.phase->messages.size(); ++i)
    if (auto added = add_edge(run, static_cast<int>(i)); !added) return added;
  add_initial(run, initial);
  add_schedule(run);
  add_past_changes(run);
  open_to_observer(run);
  return {};
}

}  // namespace bodeflow::execute
