#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "graph/graph.hpp"
#include "plan/limits.hpp"
#include "plugins/instance.hpp"

namespace bodeflow::plan {

/// What is true of a phase once every block is resolved: indices follow Phase::blocks, ports their kind-and-direction index.
struct Facts {
  struct Block {
    std::vector<StreamFacts> inputs;  ///< known = false: unconnected
    std::vector<StreamFacts> outputs;
    std::vector<Flow> input_flows;
    std::vector<Flow> output_flows;
    Rate firing_rate;              ///< firings per second; zero for a block without streams
    std::int64_t repetitions = 0;  ///< firings per period of the whole phase; zero for a block without streams
    std::int64_t firings = -1;     ///< until the block's own or the run's end; -1: no end known
  };
  std::vector<Block> blocks;
  Rate period;  ///< seconds of one repetition of the phase; zero without streams
  std::vector<std::string> warnings;
};

/// Makes and configures the instances of a phase.
tl::expected<std::vector<std::unique_ptr<Instance>>, Problems> instantiate(const graph::Phase& phase, Registry& registry,
                                                                           std::shared_ptr<const HostServices> services);

/// Resolves all blocks to a fixed point, checks every edge (element, channels, rate, unit, clock domain), solves the
/// balance equations. Errors name both ports, both blocks and both values.
tl::expected<Facts, Problems> establish_facts(const graph::Phase& phase, const std::vector<std::unique_ptr<Instance>>& instances);

/// Memory for the samples of one stream output, or of one delayed edge.
struct Buffer {
  std::uint32_t element = BF_F64;
  std::uint32_t channels = 1;
  std::uint64_t history = 0;   ///< samples kept from chunk to chunk before the new ones (largest delay of its readers)
  std::uint64_t capacity = 0;  ///< new samples of one chunk, at most
  std::uint32_t slots = 1;     ///< more than one: a ring between two threads, a slot a chunk
  std::uint64_t arena_offset =
      0;                    ///< bytes from the start of its partition's arena; buffers that do not live at the same time overlap
  std::uint64_t bytes = 0;  ///< of all slots, each channel padded to 64 bytes
  int partition = 0;        ///< whose arena it lies in: the writer's
};

/// Which buffer a stream port uses.
struct Use {
  int buffer = -1;          ///< -1: unconnected
  std::uint64_t delay = 0;  ///< samples that the reader is behind the writer
};

/// `count` firings of a block at once, within a schedule. A block without streams has count 0: its turn to take the records
/// that have come. With `to_buffer` >= 0 no call at all, but a copy: the samples that the `count` firings of `block` just
/// before wrote to `from_buffer` are appended to `to_buffer` (an edge inside a loop with initial values of its own).
struct Firing {
  int block = 0;
  std::int64_t count = 1;
  int from_buffer = -1, to_buffer = -1;
};

/// One entry of the flat list of a thread.
struct Step {
  enum class Kind {
    call,     ///< one block, all its firings of the chunk
    cluster,  ///< the blocks of a feedback loop, by `schedule`, until the chunk is done
    copy      ///< from one buffer to another (a delayed edge with initial values of its own)
  };
  Kind kind = Kind::call;
  int block = 0;                 ///< call
  std::vector<Firing> schedule;  ///< cluster: one pass
  /// Cluster: one pass of the schedule is `repetitions` periods of the loop, of which `parts` make one period of the phase. A
  /// chunk of k periods of the phase takes k * parts / repetitions passes; in the last one, if it is not whole, and at the end of
  /// a run, a block fires only as often as is left for it in the chunk.
  std::int64_t repetitions = 1;
  std::int64_t parts = 1;
  int from_buffer = -1, to_buffer = -1;  ///< copy
};

/// What one thread does in each chunk, in order.
struct Partition {
  std::vector<Step> steps;
  std::uint64_t arena_bytes = 0;
  double cost_ns = 0.0;  ///< declared, for one period of the phase
};

struct Plan {
  std::int64_t repetitions = 1;       ///< periods of the phase in one chunk
  std::vector<Partition> partitions;  ///< at least one
  std::vector<Buffer> buffers;
  /// Per block: the buffer of each stream input and output. A delayed input reads at history - delay.
  std::vector<std::vector<Use>> inputs, outputs;
  std::vector<int> partition_of;  ///< per block
  /// Per stream buffer that crosses threads: the partitions that read it (beside the writer's own).
  std::vector<std::vector<int>> readers;
  /// Blocks in a topological order of stream and message edges (delayed edges left out): the order of finish.
  std::vector<int> order;
  /// Initial values that stand in a buffer's history at the start: channels x history, channel after channel (c64: pairs); empty:
  /// zeros.
  std::vector<std::vector<double>> initial;
  std::uint64_t bytes = 0;  ///< of all buffers and rings
  double chunk_s = 0.0;
  double latency_s = 0.0;     ///< until a sample's chunk is full, and a chunk for each further thread; without computing time
  std::vector<Limit> limits;  ///< as Phase::limits
  std::vector<std::string> notes;  ///< decisions that a user may wonder about (fewer threads than asked for)
};

struct PlanOptions {
  std::int64_t chunk = 1024;
  std::optional<double> latency_s;
  std::optional<std::int64_t> periods;  ///< of the phase in a chunk, in place of `chunk` and `latency_s`
  int threads = 1;
  std::vector<graph::End> kept;  ///< stream outputs that are recorded: their buffers live to the end of the chunk
};

/// Periods of the phase in a chunk, so that `threads` chunks, one a thread, are within the latency budget; 0: not even one.
std::int64_t periods_in_chunk(const Facts& facts, const PlanOptions& options, int threads);

/// The plan of a phase; a value: the same input gives the same plan. Errors name deadlocked loops with their cycle and missing
/// samples, and what is wrong with limits.
tl::expected<Plan, Problems> make_plan(const graph::Phase& phase, const Facts& facts, const PlanOptions& options);

/// For people, and for scripts.
std::string to_text(const graph::Phase& phase, const Facts& facts, const Plan& plan);
nlohmann::json to_json(const graph::Phase& phase, const Facts& facts, const Plan& plan);

}  // namespace bodeflow::plan
