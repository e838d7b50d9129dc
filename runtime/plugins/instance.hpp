#pragma once

#include <bodeflow/rate.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string_view>

#include "plugins/registry.hpp"

namespace bodeflow {

/// Where the messages and files of blocks go; given by whoever runs them.
struct HostServices {
  std::function<void(const std::string& block, int level, const std::string& text)> log;
  std::function<void(const std::string& block, const std::string& path)> note_input;
  /// Absolute path for a block's output file, or the reason why not; absent during a check.
  std::function<tl::expected<std::string, std::string>(const std::string& block, const std::string& name)> output_path;
  /// A service of the runner's own by its id ("bodeflow.transport/1"), which outlives the blocks, or null; may be absent.
  std::function<const void*(std::string_view id)> extension;
};

/// Owned copy of bf_stream_facts.
struct StreamFacts {
  bool known = false;
  std::uint32_t element = BF_F64;
  std::uint32_t channels = 0;
  Rate rate;
  std::int64_t length = -1;
  std::string unit;
  std::string clock;
  std::vector<std::string> channel_names;
  std::vector<std::string> channel_units;
  std::map<std::string, std::vector<double>> notes;

  bool operator==(const StreamFacts&) const = default;
};

/// Owned copy of bf_flow.
struct Flow {
  std::uint32_t samples = 1;
  std::uint64_t delay = 0;
  std::vector<double> initial;  ///< empty: zeros

  bool operator==(const Flow&) const = default;
};

struct Resolution {
  std::vector<StreamFacts> outputs;
  std::vector<Flow> input_flows;
  std::vector<Flow> output_flows;
};

/// What a block says before a run.
struct AdviceText {
  int level = BF_LOG_INFO;  ///< or BF_LOG_WARNING
  std::string text;
};

/// One block of a graph: a bf_block with its host services. Every call gives the block's own words on failure.
class Instance {
 public:
  static tl::expected<std::unique_ptr<Instance>, std::string> make(Registry& registry, const std::string& id, std::string name,
                                                                   std::shared_ptr<const HostServices> services);
  /// A block of the engine's own; `block` is destroyed with the instance. `type` outlives it.
  static std::unique_ptr<Instance> own(std::string name, const BlockDescription& type,
                                       const std::function<bf_block(const bf_host&)>& make);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  const std::string& name() const;
  const BlockDescription& type() const;

  using Result = tl::expected<void, std::string>;
  Result configure(const std::vector<ParameterValue>& values);
  tl::expected<Resolution, std::string> resolve(const std::vector<StreamFacts>& inputs);
  /// What the block says to final facts; nothing from a block that gives no advice.
  tl::expected<std::vector<AdviceText>, std::string> advise(const std::vector<StreamFacts>& inputs,
                                                            const std::vector<StreamFacts>& outputs);
  Result activate(const bf_activation& activation);
  Result change(std::uint32_t parameter, const ParameterValue& value);
  Result reset();
  void deactivate();

  /// For the executor's inner loop: calls self's functions itself, then asks `take_error` when one fails.
  const bf_block& c() const;
  std::string take_error();

 private:
  Instance();
  struct State;
  std::unique_ptr<State> state_;
};

/// A reference-counted record made by the host itself (from bytes), or by a block through bf_host.
class SharedRecord {
 public:
  SharedRecord() = default;
  /// Takes over one count.
  static SharedRecord adopt(const bf_record* record);
  /// Copies the bytes.
  static SharedRecord copy(const void* bytes, std::size_t size);
  SharedRecord(const SharedRecord& other);
  SharedRecord(SharedRecord&& other) noexcept;
  SharedRecord& operator=(SharedRecord other) noexcept;
  ~SharedRecord();

  explicit operator bool() const { return record_ != nullptr; }
  const bf_record* c() const { return record_; }
  const std::uint8_t* bytes() const;
  std::size_t size() const;

 private:
  const bf_record* record_ = nullptr;
};

}  // namespace bodeflow
