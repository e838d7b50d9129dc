#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "execute/execute.hpp"
#include "record/data_writer.hpp"

namespace bodeflow::record {

class StreamQueue;
class RecordQueue;

/// Keeps what one run of a phase gives: recorded streams and all records into data.h5, changes of parameters into the events.
///
/// The threads of the run only copy, without a lock where a run keeps time; a thread of its own writes, hashes, and flushes at
/// least once a second. Queues are bounded: where the disk is slower than the run, the run waits, so that nothing is lost.
class Recorder final : public execute::Sink {
 public:
  using Event = std::function<void(const std::string& what, nlohmann::ordered_json details)>;

  /// Begins the phase in `data`. Error: why data.h5 can't take it.
  static tl::expected<std::unique_ptr<Recorder>, std::string> begin(const graph::Phase& phase, const plan::Facts& facts,
                                                                    int repeat, DataWriter& data, Event event);
  ~Recorder() override;

  tl::expected<void, std::string> samples(int recorded, const void* const* channels, std::uint64_t count) override;
  tl::expected<void, std::string> record(graph::End from, const SharedRecord& record, double time_s) override;
  void changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, execute::Cause cause) override;

  /// Writes what is left and ends the phase in data.h5. Later calls of the sink are refused. Error: the first that happened.
  tl::expected<void, std::string> finish();

  /// SHA-256 by key ("block.port", see key_of): of a stream's samples, interleaved, in little-endian bytes; of a message
  /// output's records, each as its time (f64), size (u64) and bytes. In graph order, streams as listed first. After `finish`.
  std::vector<std::pair<std::string, std::string>> hashes() const;

  struct Last {
    std::string block, port;
    SharedRecord record;
  };
  /// The last record of each message output that sent one, in graph order. After `finish`.
  std::vector<Last> last_records() const;

  /// Gives memory back; only refusing calls of the sink is left. After `finish`.
  void let_go();

 private:
  Recorder(DataWriter& data, Event event);
  void name_parameters(const graph::Phase& phase);
  void run();
  void write_until_stopped();
  void drain(bool all);
  void drain_changes();
  void wake();
  void failed(const std::string& error);
  tl::expected<void, std::string> refused() const;

  struct Change {
    std::string time;
    int block;
    int parameter;
    ParameterValue value;
    std::uint64_t position;
    execute::Cause cause;
  };
  struct BlockNames {
    std::string name;
    std::vector<std::string> parameters;
    int first_output = 0;  ///< of its message outputs among `records_`
  };

  DataWriter& data_;
  Event event_;
  std::string phase_;
  int repeat_ = 0;
  std::vector<BlockNames> blocks_;
  std::vector<int> stream_of_;  ///< per Phase::recorded: index among the streams, -1 for a message port
  bool polls_ = false;
  std::vector<std::unique_ptr<StreamQueue>> streams_;
  std::vector<std::unique_ptr<RecordQueue>> records_;

  std::mutex changes_mutex_;
  std::vector<Change> changes_;

  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable wake_;
  std::string error_;
  bool work_ = false;
  bool stop_ = false;
  std::atomic<bool> refusing_ = false;
  bool finished_ = false;
  std::thread thread_;
};

/// A parameter's value as JSON: a number, integer, bool or text, a list of them, complex values as [re, im], a matrix as rows.
nlohmann::ordered_json to_json(const ParameterValue& value);

}  // namespace bodeflow::record
