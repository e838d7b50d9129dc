#pragma once

#include <bodeflow/rate.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "parameter_text.hpp"
#include "test_host.hpp"

namespace bodeflow::testing {

/// What the inputs of a block under test are like.
struct Feed {
  std::uint32_t channels = 1;
  std::map<std::string, std::uint32_t> channels_of;                         ///< of ports that have others
  std::map<std::string, std::map<std::string, std::vector<double>>> notes;  ///< of the streams, by port
  std::set<std::string> unconnected;                                        ///< optional ports
  std::uint32_t element = BF_F64;                                           ///< of ports that take either
  Rate rate{1000, 1};
  std::uint64_t firings = 2600;
  std::uint64_t period = 0;  ///< samples after which the signal repeats, but for some noise; 0: it is all noise
  bool optional_connected = true;
  enum class Signal { ordinary, bad } signal = Signal::ordinary;  ///< bad: NaN, infinite, denormal, huge
  enum class Messages { none, empty } messages = Messages::none;  ///< empty: a record without content to each message input

  bool operator==(const Feed& o) const {
    return channels == o.channels && channels_of == o.channels_of && notes == o.notes && unconnected == o.unconnected &&
           element == o.element && rate == o.rate && firings == o.firings && period == o.period &&
           optional_connected == o.optional_connected && signal == o.signal && messages == o.messages;
  }
};

/// A block with its parameters and inputs.
struct Case {
  const bf_factory* factory = nullptr;
  const bf_block_descriptor* block = nullptr;
  std::vector<StoredValue> values;
  Feed feed;
};

/// The facts of a stream that a block stated, copied.
struct OutputFacts {
  bool known = false;
  std::uint32_t element = 0, channels = 0;
  Rate rate;
  std::int64_t length = -1;
  std::string unit, clock;
  std::vector<std::string> channel_names, channel_units;

  bool operator==(const OutputFacts& o) const {
    return known == o.known && element == o.element && channels == o.channels && rate == o.rate && length == o.length &&
           unit == o.unit && clock == o.clock && channel_names == o.channel_names && channel_units == o.channel_units;
  }
};

struct FlowFacts {
  std::uint32_t samples = 1;
  std::uint64_t delay = 0;
  std::vector<double> initial;

  bool operator==(const FlowFacts& o) const { return samples == o.samples && delay == o.delay && initial == o.initial; }
};

struct Resolved {
  std::vector<OutputFacts> outputs;
  std::vector<FlowFacts> input_flows, output_flows;

  bool operator==(const Resolved& o) const {
    return outputs == o.outputs && input_flows == o.input_flows && output_flows == o.output_flows;
  }
};

/// A record that a block sent.
struct SentRecord {
  std::uint32_t port = 0;
  std::uint64_t position = 0;  ///< firing
  std::vector<std::uint8_t> bytes;
};

/// All that a block gave.
struct Trace {
  std::vector<std::vector<std::vector<std::uint8_t>>> outputs;  ///< by output and channel
  bool inputs_intact = true;                                    ///< unless run in place
  std::vector<SentRecord> records;
  std::uint64_t firings = 0;
  std::string failure;  ///< the block's words if process or finish failed
};

/// How a run is cut into calls.
struct Calls {
  std::uint64_t first = 0;  ///< firings of the first call; 0: as the others
  std::uint64_t size = 1000;
  std::uint8_t fill = 0;        ///< what outputs hold before
  bool in_place = false;        ///< outputs share the memory of inputs where the block says that it may
  std::int64_t change_at = -1;  ///< firing before which `change` is made
  std::uint32_t change_parameter = 0;
  StoredValue change_value{};
  bool hooked = false;       ///< fails if process allocates, locks or does input or output
  bool all_at_once = false;  ///< a call may be as long as the run
};

/// One block under test. Throws Failure with the block's own words when a call fails; only a run keeps them in its trace,
/// because a block may refuse data.
class Rig {
 public:
  explicit Rig(const Case& the_case);
  ~Rig();
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  void configure();
  /// Resolves with the inputs of the feed; `known` = false: as at the first pass within a loop.
  Resolved resolve(bool known = true);
  /// resolve, then activate for calls of up to `max_count` firings.
  void activate(std::uint64_t max_count);
  /// All samples of the feed, in calls as told, and `finish`.
  Trace run(const Calls& calls);
  void reset();
  void deactivate();

  const TestHost& host() const { return *host_; }
  const Resolved& facts() const { return facts_; }

 private:
  friend class Run;
  void require(std::int32_t result, const char* function) const;
  std::vector<bf_stream_facts> input_facts(bool known) const;
  void advise(const bf_resolution& resolved) const;
  /// Of the feed, fewer where a firing has very many samples.
  std::uint64_t firings() const;

  const Case& case_;
  std::unique_ptr<TestHost> host_;
  bf_block block_{};
  std::vector<const bf_port_descriptor*> inputs_, outputs_, message_inputs_;
  std::vector<std::vector<bf_note>> notes_;  // by input
  std::uint32_t message_outputs_ = 0;
  Resolved facts_;
  bool active_ = false;
};

/// "" if two runs gave the same bits and records, else where they differ first. `a` and `b` name the runs in the text.
std::string difference(const Case& the_case, const Trace& first, const std::string& a, const Trace& second, const std::string& b);

}  // namespace bodeflow::testing
