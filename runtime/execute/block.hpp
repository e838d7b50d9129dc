#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "execute/inbox.hpp"
#include "execute/lane.hpp"
#include "execute/remote_end.hpp"
#include "graph/graph.hpp"

namespace bodeflow::execute {

struct Run;
struct Chunk;
struct Asked;
class Guard;

/// Where a record goes from a message output.
struct Route {
  int to = 0;                 ///< block
  int port = 0;               ///< message input, or graph::kParameterPort
  Rate latency{0, 1};         ///< seconds
  int edge = 0;               ///< index into Phase::messages
  bool remote = false;        ///< the consumer's thread may be another one than the producer's
  bool horizon = false;       ///< a block without streams on another thread wants to know how far we are
  std::string type;           ///< the only record type that the input takes, or ""
  std::int64_t sequence = 0;  ///< records sent so far
};

/// A message input's producer, in the eyes of a block without streams that asks what can still come.
struct Origin {
  int block = 0;
  int edge = 0;
  Rate latency{0, 1};
  bool remote = false;
  std::int64_t lag = 0;  ///< remote: chunks that the latency is long
};

/// A stream port of a block: where its samples lie in each chunk.
struct StreamPort {
  int buffer = -1;                           ///< -1: unconnected
  std::uint32_t samples = 1;                 ///< a firing
  std::uint64_t base = 0;                    ///< sample of the buffer where a chunk begins
  std::vector<std::vector<void*>> channels;  ///< by slot
};

/// Where a block's input samples come from.
struct Feed {
  int block = 0;
  int port = 0;
  std::int64_t produced = 1, consumed = 1;  ///< samples a firing
};

/// A block while it runs. All but `end` and the inbox's sending side belongs to the thread that runs it.
struct alignas(64) BlockRun {
  BlockRun() = default;
  BlockRun(const BlockRun&) = delete;
  BlockRun& operator=(const BlockRun&) = delete;

  // The innermost loop needs only these.
  bf_process process{};
  std::int32_t (*call)(void*, bf_process*) = nullptr;
  void* self = nullptr;
  std::int64_t position = 0;  ///< firings made
  std::int64_t count = 0;     ///< of the call; `process` lies open to the block
  std::uint64_t calls = 0;
  std::vector<bf_stream> streams;  ///< inputs, then outputs
  bool fault = false;              ///< a wrong emit: `fault_text`
  bool takes_messages = false;
  int index = 0;
  const Control* control = nullptr;

  Run* run = nullptr;
  Instance* instance = nullptr;
  int partition = 0;
  std::vector<StreamPort> ports;    ///< as `streams`
  std::size_t inputs = 0;           ///< of them
  bool rotates = false;             ///< a port lies in a ring
  std::int64_t per_repetition = 0;  ///< firings in a period of the phase; 0: no streams
  Rate rate;                        ///< firings per second
  bool source = false;              ///< no stream inputs: it says itself when it ends
  std::vector<Feed> feeds;
  std::atomic<std::int64_t> end{kNever};  ///< firings until the end of its streams, as far as known
  std::atomic<std::int64_t> reached{0};   ///< `position`, now and then, for the watchdog and who looks on
  std::atomic<Asked*> asked{nullptr};     ///< the last change that was asked for from outside and not taken yet
  std::int64_t changes_taken = 0;         ///< of those
  std::vector<ParameterValue> values;     ///< of all parameters, where an observer may change them

  Inbox inbox;
  std::vector<std::vector<Route>> routes;  ///< by message output
  std::vector<std::string> sends;          ///< by message output: the record type that is described, or ""
  std::vector<Origin> origins;             ///< blocks without streams: who sends here
  Horizon horizon;                         ///< blocks without streams: all before it is done
  Time now;                                ///< of the record being taken, for blocks without streams
  std::vector<bf_message> messages;        ///< of the coming call
  std::vector<SharedRecord> held;          ///< and their records
  std::string fault_text;
  RemoteEnd* remote = nullptr;  ///< one end of a link to another process
  Guard* guard = nullptr;       ///< of its limits, if it has any
  int worker = -1;              ///< asynchronous: index of its worker

  double timed_s = 0.0;  ///< of the firings that were timed
  std::int64_t timed_firings = 0;
  double other_s = 0.0;  ///< records, changes, finish: all of them
  std::uint64_t dropped = 0;

  bool has_streams() const { return per_repetition > 0; }
};

/// Puts the streams of `block` to the start of `chunk`.
void begin_chunk(BlockRun& block, const Chunk& chunk);

/// Puts the streams back to where a chunk begins.
void rewind(BlockRun& block);

/// After a call that failed, is wrong, or was the last one: ends the run, or takes note of a source's end. False: stop.
bool settle(BlockRun& block, std::int32_t status);

void set_count(BlockRun& block, std::int64_t count);

/// Makes `count` firings in one call; the streams stay where they are. False: the run is to end, Control knows why.
inline bool fire_here(BlockRun& block, std::int64_t count, Lane& lane) {
  bf_process& process = block.process;
  const auto firings = static_cast<std::uint64_t>(count);
  if (block.count != count) set_count(block, count);
  process.count = firings;
  process.position = static_cast<std::uint64_t>(block.position);
  process.done = firings;
  lane.call(block.index);
  ++block.calls;
  const std::int32_t status = block.call(block.self, &process);
  if (status != BF_OK || block.fault || process.done != firings || block.control->stopping()) [[unlikely]]
    return settle(block, status);
  block.position += count;
  return true;
}

/// As `fire_here`, and moves the streams on behind what was read and written.
inline bool fire(BlockRun& block, std::int64_t count, Lane& lane) {
  const std::int64_t before = block.position;
  if (!fire_here(block, count, lane)) return false;
  if (block.position - before != count) [[unlikely]]
    return true;  // a source that ended: nobody reads on there
  for (bf_stream& stream : block.streams) stream.offset += stream.count;
  return true;
}

/// Makes the firings up to `end` (an index), taking records and changes where they are due and never more than
/// Options::call_limit at once. False: the run is to end.
bool fire_to(BlockRun& block, std::int64_t end, Lane& lane);

/// A block with streams takes the changes that were asked for from outside: they stand before its coming firing. Whatever else
/// is due before that firing has been sent and is not taken yet.
void take_asked(BlockRun& block);
/// A block without streams takes them at the begin of the first period of the phase at or behind `horizon`, before which it may
/// have taken all.
void take_asked_before(BlockRun& block, const Horizon& horizon);

/// Brings in what other threads sent or asked for.
inline void collect(BlockRun& block) {
  block.inbox.collect();
  if (block.has_streams() && block.asked.load(std::memory_order_relaxed) != nullptr) take_asked(block);
}

/// Fires as `fire_to`, over the short way where nothing is due.
inline bool advance(BlockRun& block, std::int64_t count, bool limited, Lane& lane) {
  const bool plain = !limited && (!block.takes_messages || block.inbox.next_due() >= block.position + count);
  return plain ? fire(block, count, lane) : fire_to(block, block.position + count, lane);
}

/// A block without streams takes what no earlier record can overtake any more. False: the run is to end.
bool take_turn(BlockRun& block, const Chunk& chunk, Lane& lane);

/// Takes the records that are left, in calls without firings. Changes have no effect any more on a block with streams; on
/// others those up to `end` have. False: the run is to end.
bool take_rest(BlockRun& block, const Time& end, Lane& lane);

/// Takes one entry of a block without streams in a call of its own. False: the run is to end.
bool take_alone(BlockRun& block, Entry entry, Lane& lane);

/// finish(), at the block's last position. False: the run is to end.
bool finish(BlockRun& block, Lane& lane);

/// bf_process.emit.
void emit(bf_process* process, std::uint32_t port, bf_record* record, std::uint64_t offset);

/// Lowers `end` to what the inputs still give; true if it changed.
bool update_end(BlockRun& block);

}  // namespace bodeflow::execute
