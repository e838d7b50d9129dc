#pragma once

#include <bodeflow/rate.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "graph/problem.hpp"
#include "plugins/description.hpp"

namespace bodeflow::graph {

/// A block of a phase with its checked parameters.
struct Block {
  std::string name;
  const BlockDescription* type = nullptr;
  std::vector<ParameterValue> parameters;  ///< one per described parameter, defaults filled in
  std::vector<Place> parameter_places;     ///< where each was written; the block's place for defaults
  Place place;
  std::string host;  ///< "" : where the graph was started
};

/// One end of a connection: block and port, the port by kind-and-direction index.
struct End {
  int block = 0;
  int port = 0;

  bool operator==(const End&) const = default;
};

/// Index of a block's implicit message input that takes `parameter_change` records {parameter, value}.
inline constexpr int kParameterPort = -1;

struct StreamEdge {
  End from;  ///< stream output
  End to;    ///< stream input
  Place place;
};

/// How long a record waits: exactly one of the two is non-zero, or none.
struct Latency {
  Rate seconds{0, 1};        ///< a fraction, in seconds
  std::int64_t samples = 0;  ///< of the consumer
};

struct MessageEdge {
  End from;  ///< message output
  End to;    ///< message input, or kParameterPort
  Latency latency;
  Place place;
};

/// A record of an earlier phase, given to a message input at time zero.
struct Reference {
  std::string phase;
  std::string block;
  std::string port;
  End to;
  Place place;
};

/// A live parameter that changes at a stated time.
struct ScheduledChange {
  double time_s = 0.0;
  int block = 0;
  int parameter = 0;
  ParameterValue value;
  Place place;
};

/// A port whose data is kept in data.h5.
struct RecordedPort {
  End port;
  std::uint32_t kind = BF_STREAM;
};

/// A number as written: what it is in the stream's unit is known once the stream is.
struct Quantity {
  std::string text;
  Place place;
};

/// What happens when a signal leaves its limits: samples of an input are held within them; the run ends; it is only told.
enum class OnViolation { clamp, stop, warn };

/// Limits of one stream port, enforced by the runtime whatever the block does.
struct Limit {
  End port;
  bool input = false;   ///< a stream input: its samples are looked at before the block gets them
  std::string channel;  ///< name or number; "": all
  std::optional<Quantity> min, max, rate;
  std::optional<double> time_s;  ///< a violation must act within this
  OnViolation on_violation = OnViolation::stop;
  Place place, channel_place, time_place;
};

enum class Clock { simulated, realtime, hardware };

/// What a paced run does when a chunk's time is over before its thread comes to it: counts it and goes on without a pause until
/// it has caught up; counts it and leaves out the whole chunks of time that were lost, so that it need not catch up; ends.
enum class Overrun { count, skip, stop };

/// What stands where a lost host's samples are missing, once its part was started again.
enum class Gaps { nan, hold };

struct RunSettings {
  Clock clock = Clock::simulated;
  std::optional<double> duration_s;
  std::uint64_t seed = 1;
  std::int64_t chunk = 1024;        ///< samples of the fastest stream in one call, at most
  std::optional<double> latency_s;  ///< budget: the chunk is not longer than this
  int threads = 1;
  Overrun on_overrun = Overrun::count;
  std::optional<int> priority;     ///< SCHED_FIFO of the compute threads, with locked memory; as any other program otherwise
  std::vector<int> cores;          ///< compute threads are bound to these, in turn; empty: to none
  double watchdog_s = 10.0;        ///< a graph without progress for this long is ended and named
  double tolerance_s = 10.0;       ///< between hosts: a connection without progress for this long ends the run
  bool survives_launcher = false;  ///< hosts go on with a phase when the process that started the run is lost
  bool restart = false;            ///< the part of a host that is lost is started again
  Gaps gaps = Gaps::nan;
};

/// `$phase.block.port.attribute OP value`, or the attribute alone (true, non-zero).
struct Condition {
  std::string phase, block, port, attribute;
  std::string comparison;  ///< "", "==", "!=", "<", "<=", ">", ">="
  std::variant<bool, double, std::string> value;
  Place place;
};

/// One axis of a sweep: `seed: 1..100`, or `gain.gain: [1, 2, 3]` in the graph's own words.
struct SweepAxis {
  std::string path;
  std::vector<std::string> values;
  Place place;
};

struct Phase {
  std::string name;  ///< "" in a graph without phases
  Place place;
  std::vector<Block> blocks;
  std::vector<StreamEdge> streams;
  std::vector<MessageEdge> messages;
  std::vector<Reference> references;
  std::vector<ScheduledChange> schedule;  ///< ordered by time, then as written
  std::vector<RecordedPort> recorded;
  std::vector<Limit> limits;  ///< of one port: in the order in which they act
  RunSettings run;
  std::optional<Condition> when;
  int repeat_max = 1;
  std::optional<Condition> until;
  std::vector<SweepAxis> sweep;

  int block_index(const std::string& name) const;  ///< -1: none
};

/// What a run shows at its end.
struct Summary {
  std::vector<std::string> show;  ///< results by their names in result.json, in order; empty: all
  std::string next;               ///< what to type next
};

struct Graph {
  std::string file;
  std::string title;
  Summary summary;
  std::vector<Phase> phases;
  std::string expanded;  ///< the graph as one self-contained YAML text, overrides applied
};

}  // namespace bodeflow::graph
