#pragma once

#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "execute/execute.hpp"
#include "observe/watch.hpp"

namespace bodeflow::test {

/// A record as it went to the sink.
struct Sent {
  std::vector<std::uint8_t> bytes;
  double time_s = 0.0;

  double value() const;
  bool operator==(const Sent&) const = default;
};

struct Changed {
  std::string block, parameter;
  ParameterValue value;
  std::uint64_t position = 0;
  execute::Cause cause = execute::Cause::schedule;

  bool operator==(const Changed&) const = default;
};

/// All that a run gave.
struct Result {
  execute::Outcome outcome;
  std::vector<plan::Limit> limits;                                  ///< of the plan
  std::size_t threads = 0;                                          ///< that the plan used
  std::map<std::string, std::vector<std::vector<double>>> streams;  ///< "block.port": channels
  std::map<std::string, std::vector<Sent>> records;                 ///< "block.port"
  std::map<std::string, std::vector<Changed>> changes;              ///< by block
  std::vector<std::pair<std::string, std::string>> log;             ///< block, text

  const std::vector<double>& stream(const std::string& port) const { return streams.at(port).front(); }
  /// What a block logged.
  std::vector<std::string> said(const std::string& block) const;
  /// Everything but times of day and metrics, bit for bit.
  bool same_data(const Result& other) const;
};

using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// How one run is cut.
struct Cut {
  std::int64_t chunk = 1024;
  int threads = 1;
  std::uint64_t first_chunk = 0;
  std::int64_t call_limit = 0;
};

using OnSamples = std::function<tl::expected<void, std::string>(const std::string& port)>;

/// The blocks of the fixtures.
Registry& test_registry();

/// A phase put together in code, with blocks of the fixtures. All streams are recorded.
class Bench {
 public:
  Bench();

  graph::Phase phase;
  execute::Options options;
  /// Called with each piece of a stream that is kept; an error ends the run.
  OnSamples on_samples;
  std::vector<execute::InitialRecord> initial;
  /// Sees the run, where set.
  observe::Watch* watch = nullptr;

  int add(const std::string& name, const std::string& id, const std::map<std::string, Value>& parameters = {});
  /// "a.out" to "b.in", or "a" to "b" for the first ports.
  void connect(const std::string& from, const std::string& to);
  /// Message output to message input, or to "b.parameters".
  void tell(const std::string& from, const std::string& to, graph::Latency latency = {});
  void schedule(double time_s, const std::string& block, const std::string& parameter, const Value& value);
  /// A limit of a stream input, "a.in", that clamps, or of a stream output, "a.out", that stops; to be filled in.
  graph::Limit& limit_input(const std::string& signal);
  graph::Limit& limit_output(const std::string& signal);
  /// A number record for a message input at time zero.
  void give(const std::string& to, double value);
  void duration(double seconds) { phase.run.duration_s = seconds; }

  /// Plans and runs it with new instances.
  Result run(const Cut& cut = {});
  /// Runs it on the hosts that the blocks name, each in a thread of its own, over links in memory.
  tl::expected<Result, Problems> run_on_hosts(const Cut& cut = {});
  /// As `run`; the instances outlive the call: for runs that leave a thread behind.
  Result run(const Cut& cut, std::vector<std::unique_ptr<Instance>>& instances);

  /// The same data for every chunk size, boundary, call size and number of threads.
  void check_identity();

 private:
  graph::End find(const std::string& text, std::uint32_t kind, std::uint32_t direction) const;
};

/// Seconds as an exact fraction.
inline graph::Latency after(std::int64_t num, std::int64_t den) { return {Rate(num, den), 0}; }
inline graph::Latency after_samples(std::int64_t samples) { return {Rate(0, 1), samples}; }

}  // namespace bodeflow::test
