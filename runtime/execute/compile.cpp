// From a plan to what its threads call: blocks with their streams, ops, dependencies.
#include "execute/compile.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bodeflow::execute {
namespace {

using Failed = tl::unexpected<std::string>;

StreamPort stream_port(const BufferView& buffer, int index, std::uint32_t samples, std::uint64_t base) {
  StreamPort port;
  port.buffer = index;
  port.samples = samples;
  port.base = base;
  for (std::uint32_t slot = 0; slot < buffer.slots; ++slot) {
    port.channels.emplace_back();
    for (std::uint32_t c = 0; c < buffer.channels; ++c) port.channels.back().push_back(buffer.at(slot, c, 0));
  }
  return port;
}

void add_stream(BlockRun& block, StreamPort port, std::uint32_t channels, std::uint32_t element) {
  bf_stream stream{};
  stream.channel_count = channels;
  stream.element = element;
  stream.offset = port.base;
  block.rotates = block.rotates || port.channels.size() > 1;
  block.ports.push_back(std::move(port));
  block.streams.push_back(stream);
}

/// The block's streams in the plan's buffers; an output that the plan gives no buffer gets one of its own.
tl::expected<void, std::string> add_streams(Run& run, BlockRun& block) {
  const plan::Facts::Block& facts = run.facts->blocks[static_cast<std::size_t>(block.index)];
  const auto& inputs = run.plan->inputs[static_cast<std::size_t>(block.index)];
  const auto& outputs = run.plan->outputs[static_cast<std::size_t>(block.index)];
  if (inputs.size() != facts.inputs.size() || outputs.size() != facts.outputs.size())
    return Failed(fmt::format("plan: block '{}' has {} inputs and {} outputs, its facts have {} and {}", run.name(block.index),
                              inputs.size(), outputs.size(), facts.inputs.size(), facts.outputs.size()));
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const int index = inputs[i].buffer;
    if (index < 0) {
      add_stream(block, StreamPort{}, 0, facts.inputs[i].element);
      continue;
    }
    const BufferView& buffer = run.memory[index];
    if (inputs[i].delay > buffer.history)
      return Failed(fmt::format("plan: input {} of block '{}' is delayed by {} samples, its buffer keeps {}", i,
                                run.name(block.index), inputs[i].delay, buffer.history));
    add_stream(block, stream_port(buffer, index, facts.input_flows[i].samples, buffer.history - inputs[i].delay), buffer.channels,
               facts.inputs[i].element);
  }
  block.inputs = inputs.size();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::uint32_t samples = facts.output_flows[i].samples;
    const std::uint64_t capacity = static_cast<std::uint64_t>(run.chunking.periods * block.per_repetition) * samples;
    const int index = outputs[i].buffer >= 0
                          ? outputs[i].buffer
                          : run.memory.add_scratch(facts.outputs[i].element, facts.outputs[i].channels, capacity);
    const BufferView& buffer = run.memory[index];
    if (buffer.capacity < capacity)
      return Failed(fmt::format("plan: buffer {} holds {} new samples, block '{}' writes {} in a chunk", index, buffer.capacity,
                                run.name(block.index), capacity));
    add_stream(block, stream_port(buffer, index, samples, buffer.history), buffer.channels, facts.outputs[i].element);
  }
  // The vectors stand now: what the ABI points to stays.
  for (std::size_t i = 0; i < block.ports.size(); ++i)
    block.streams[i].channels = block.ports[i].channels.empty() ? nullptr : block.ports[i].channels.front().data();
  block.process.inputs = block.streams.data();
  block.process.outputs = block.streams.data() + block.inputs;
  return {};
}

tl::expected<void, std::string> add_block(Run& run, int index, Instance& instance) {
  const plan::Facts::Block& facts = run.facts->blocks[static_cast<std::size_t>(index)];
  auto made = std::make_unique<BlockRun>();
  BlockRun& block = *made;
  run.blocks.push_back(std::move(made));
  block.index = index;
  block.run = &run;
  block.control = &run.control;
  if (const auto remote = run.options.remote_ends.find(index); remote != run.options.remote_ends.end())
    block.remote = remote->second;
  block.instance = &instance;
  block.call = instance.c().process;
  block.self = instance.c().self;
  if (block.call == nullptr) return Failed(fmt::format("block '{}' has no process function", run.name(index)));
  block.process.struct_size = sizeof(bf_process);
  block.process.context = &block;
  block.process.emit = emit;
  block.partition = run.plan->partition_of[static_cast<std::size_t>(index)];
  block.per_repetition = facts.repetitions;
  block.rate = facts.firing_rate;
  if (facts.repetitions > 0 && !facts.firing_rate.known())
    return Failed(fmt::format("plan: block '{}' has streams and no rate", run.name(index)));
  if (facts.repetitions > 0 && facts.firings >= 0) block.end.store(facts.firings, std::memory_order_relaxed);
  return add_streams(run, block);
}

void add_feeds(Run& run) {
  for (const graph::StreamEdge& edge : run.phase->streams) {
    const auto& from = run.facts->blocks[static_cast<std::size_t>(edge.from.block)];
    const auto& to = run.facts->blocks[static_cast<std::size_t>(edge.to.block)];
    run.block(edge.to.block)
        .feeds.push_back({edge.from.block, edge.from.port, from.output_flows[static_cast<std::size_t>(edge.from.port)].samples,
                          to.input_flows[static_cast<std::size_t>(edge.to.port)].samples});
  }
  for (const auto& block : run.blocks) block->source = block->has_streams() && block->feeds.empty();
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& block : run.blocks) changed = update_end(*block) || changed;
  }
}

CopyRun copy_of(Run& run, int writer, int from, int to) {
  const auto& outputs = run.plan->outputs[static_cast<std::size_t>(writer)];
  CopyRun copy{&run.block(writer), 1, from, to, 0};
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (outputs[i].buffer == from) copy.samples = run.facts->blocks[static_cast<std::size_t>(writer)].output_flows[i].samples;
  return copy;
}

Turn turn_of(Run& run, Op& op, const plan::Firing& firing) {
  Turn turn;
  turn.block = &run.block(firing.block);
  turn.count = firing.count;
  if (firing.to_buffer >= 0) {
    turn.kind = Turn::Kind::copy;
    const auto same = [&](const CopyRun& copy) { return copy.from == firing.from_buffer && copy.to == firing.to_buffer; };
    const auto known = std::find_if(op.copies.begin(), op.copies.end(), same);
    turn.copy = static_cast<std::size_t>(known - op.copies.begin());
    if (known == op.copies.end()) op.copies.push_back(copy_of(run, firing.block, firing.from_buffer, firing.to_buffer));
  } else if (!turn.block->has_streams()) {
    turn.kind = Turn::Kind::take;
  }
  return turn;
}

Op op_from(Run& run, const plan::Step& step) {
  Op op;
  op.kind = step.kind;
  if (step.kind == plan::Step::Kind::copy) {
    op.copies.push_back(copy_of(run, step.block, step.from_buffer, step.to_buffer));
  } else if (step.kind == plan::Step::Kind::call) {
    op.block = &run.block(step.block);
    op.blocks.push_back(op.block);
  } else {
    op.repetitions = step.repetitions;
    op.parts = step.parts;
    for (const plan::Firing& firing : step.schedule) {
      op.turns.push_back(turn_of(run, op, firing));
      BlockRun* block = op.turns.back().block;
      if (std::find(op.blocks.begin(), op.blocks.end(), block) == op.blocks.end()) op.blocks.push_back(block);
      op.has_source = op.has_source || block->source;
    }
  }
  return op;
}

void add_recorded(Run& run, Op& op) {
  for (std::size_t i = 0; i < run.phase->recorded.size(); ++i) {
    const graph::RecordedPort& port = run.phase->recorded[i];
    if (port.kind != BF_STREAM) continue;
    for (const BlockRun* block : op.blocks) {
      if (block->index != port.port.block) continue;
      const StreamPort& stream = block->ports[block->inputs + static_cast<std::size_t>(port.port.port)];
      op.recorded.push_back({static_cast<int>(i), block, stream.samples, stream.buffer, {}});
      op.recorded.back().channels.resize(run.memory[stream.buffer].channels);
    }
  }
}

void add_partition(Run& run, int index) {
  const plan::Partition& planned = run.plan->partitions[static_cast<std::size_t>(index)];
  auto made = std::make_unique<PartitionRun>();
  PartitionRun& partition = *made;
  run.partitions.push_back(std::move(made));
  partition.run = &run;
  partition.index = index;
  partition.full_periods = kNever;
  for (const plan::Step& step : planned.steps) {
    partition.ops.push_back(op_from(run, step));
    add_recorded(run, partition.ops.back());
    for (BlockRun* block : partition.ops.back().blocks) partition.blocks.push_back(block);
  }
  std::int64_t most = 0;
  for (const BlockRun* block : partition.blocks) {
    if (!block->has_streams()) continue;
    most = std::max(most, block->per_repetition * run.chunking.periods);
    const std::int64_t end = block->end.load(std::memory_order_relaxed);
    if (end != kNever) partition.full_periods = std::min(partition.full_periods, end / block->per_repetition);
  }
  if (most == 0) partition.full_periods = 0;
  // Looks at the clock stay below 5 % of the work also where a chunk is one sample.
  constexpr std::int64_t kShortChunk = 256;
  partition.timing = most >= kShortChunk ? 64 : 256;
  run.control.watch(partition.signal);
}

/// Buffers with a past or with readers on other threads. A copy's buffer belongs to the block whose samples it gets.
void add_carried(Run& run) {
  const auto add = [&](int buffer, const BlockRun& writer, std::int64_t samples) {
    const BufferView& view = run.memory[buffer];
    const auto index = static_cast<std::size_t>(buffer);
    std::vector<int> readers = index < run.plan->readers.size() ? run.plan->readers[index] : std::vector<int>{};
    if (view.history == 0 && readers.empty()) return;
    run.partitions[static_cast<std::size_t>(writer.partition)]->carried.push_back(
        {buffer, writer.per_repetition * samples, std::move(readers), writer.index});
  };
  for (const auto& block : run.blocks)
    for (std::size_t i = block->inputs; i < block->ports.size(); ++i)
      add(block->ports[i].buffer, *block, block->ports[i].samples);
  for (const auto& partition : run.partitions)
    for (const Op& op : partition->ops)
      for (const CopyRun& copy : op.copies) add(copy.to, *copy.writer, copy.samples);
}

/// The op after which a chunk's samples stand in the buffer that an input reads: its producer's, or that of a copy.
std::int64_t op_that_fills(const Run& run, const PartitionRun& partition, const graph::StreamEdge& edge) {
  const int buffer = run.plan->inputs[static_cast<std::size_t>(edge.to.block)][static_cast<std::size_t>(edge.to.port)].buffer;
  for (std::size_t i = 0; i < partition.ops.size(); ++i)
    for (const CopyRun& copy : partition.ops[i].copies)
      if (copy.to == buffer) return static_cast<std::int64_t>(i);
  return op_of(partition, edge.from.block);
}

tl::expected<void, std::string> add_dependencies(Run& run) {
  for (const graph::StreamEdge& edge : run.phase->streams) {
    const BlockRun &from = run.block(edge.from.block), &to = run.block(edge.to.block);
    const PartitionRun& partition = *run.partitions[static_cast<std::size_t>(from.partition)];
    const std::int64_t op = op_that_fills(run, partition, edge);
    if (from.partition != to.partition) {
      depend(run, from.index, op, to.index, Lane::Wait::samples, 0);
    } else {
      if (op_of(partition, to.index) < op)
        return Failed(fmt::format("plan: block '{}' is called before block '{}', whose samples it takes", run.name(to.index),
                                  run.name(from.index)));
    }
  }
  return {};
}

/// No thread begins a chunk before one that may end the run by a limit has done the chunk as many before it as there are threads.
void add_limit_dependencies(Run& run) {
  const auto threads = static_cast<std::int64_t>(run.partitions.size());
  for (std::size_t i = 0; i < run.plan->limits.size(); ++i) {
    if (run.plan->limits[i].on_violation != graph::OnViolation::stop) continue;
    const int block = run.phase->limits[i].port.block;
    PartitionRun& watching = *run.partitions[static_cast<std::size_t>(run.block(block).partition)];
    for (const auto& other : run.partitions)
      if (other.get() != &watching)
        depend(run, block, op_of(watching, block), other->ops.front().blocks.front()->index, Lane::Wait::samples, threads);
  }
}

/// Calls that may go the short way: their streams stand at a chunk's start whenever none is under way.
void mark_plain(Run& run) {
  for (const auto& partition : run.partitions)
    for (Op& op : partition->ops) {
      const bool alone = op.dependencies.empty() && op.recorded.empty() && !op.followed;
      if (op.kind != plan::Step::Kind::call || !alone || run.options.call_limit > 0) continue;
      BlockRun& block = *op.block;
      if (!block.has_streams() || block.takes_messages || block.rotates || block.remote != nullptr) continue;
      rewind(block);
      op.plain = &block;
    }
}

}  // namespace

std::int64_t op_of(const PartitionRun& partition, int block) {
  for (std::size_t i = 0; i < partition.ops.size(); ++i)
    for (const BlockRun* called : partition.ops[i].blocks)
      if (called->index == block) return static_cast<std::int64_t>(i);
  return -1;
}

void depend(Run& run, int from, std::int64_t op, int to, Lane::Wait kind, std::int64_t lag) {
  const BlockRun &producer = run.block(from), &consumer = run.block(to);
  if (producer.partition == consumer.partition) return;
  PartitionRun& before = *run.partitions[static_cast<std::size_t>(producer.partition)];
  PartitionRun& after = *run.partitions[static_cast<std::size_t>(consumer.partition)];
  before.ops[static_cast<std::size_t>(op)].followed = true;
  after.ops[static_cast<std::size_t>(op_of(after, to))].dependencies.push_back({producer.partition, op, lag, kind, to, from});
}

tl::expected<void, std::string> compile(Run& run, const std::vector<std::unique_ptr<Instance>>& instances,
                                        const std::vector<InitialRecord>& initial) {
  const std::size_t count = run.phase->blocks.size();
  const plan::Plan& plan = *run.plan;
  if (run.facts->blocks.size() != count || plan.inputs.size() != count || plan.outputs.size() != count ||
      plan.partition_of.size() != count || plan.order.size() != count || instances.size() != count)
    return Failed(fmt::format("plan: made for another phase: it has {} blocks, the phase {}, the instances {}", plan.order.size(),
                              count, instances.size()));
  run.period = run.facts->period;
  run.chunking.periods = std::max<std::int64_t>(1, plan.repetitions);
  if (run.options.first_chunk > 0 && run.options.first_chunk < static_cast<std::uint64_t>(run.chunking.periods))
    run.chunking.first = static_cast<std::int64_t>(run.options.first_chunk);
  auto memory = Memory::make(plan);
  if (!memory) return Failed(memory.error());
  run.memory = std::move(*memory);
  for (std::size_t i = 0; i < count; ++i)
    if (auto added = add_block(run, static_cast<int>(i), *instances[i]); !added) return added;
  add_feeds(run);
  for (std::size_t i = 0; i < plan.partitions.size(); ++i) add_partition(run, static_cast<int>(i));
  for (const auto& block : run.blocks)
    if (op_of(*run.partitions[static_cast<std::size_t>(block->partition)], block->index) < 0)
      return Failed(fmt::format("plan: block '{}' has no step", run.name(block->index)));
  add_carried(run);
  if (auto added = add_dependencies(run); !added) return added;
  if (auto compiled = compile_messages(run, initial); !compiled) return compiled;
  guard_limits(run);
  add_limit_dependencies(run);
  mark_plain(run);
  return {};
}

}  // namespace bodeflow::execute
