#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "observe/tap.hpp"
#include "plan/plan.hpp"

namespace bodeflow::observe {

/// A change of a live parameter that somebody asked for, and what became of it.
struct Change {
  enum class Status {
    waiting,
    taken,    ///< in effect from `position` on
    refused,  ///< by the block; it keeps the value that it had
    missed    ///< the phase ended before
  };
  std::string phase;
  int repeat = 0;
  std::string block, parameter;
  ParameterValue value;
  Status status = Status::waiting;
  std::int64_t position = -1;  ///< firing of the block; of a block without streams, period of the phase
  double time_s = 0.0;         ///< of it
  std::string refusal;
};

/// The last record of a message output in the run so far.
struct Record {
  std::string key;  ///< as in result.json
  SharedRecord record;
  double time_s = 0.0;
  std::uint64_t count = 0;    ///< in its phase
  std::uint64_t version = 0;  ///< another one with every record of the run that is kept here
};

/// A phase that runs, or the one that ran last: what stays the same in it.
struct PhaseFacts {
  const graph::Phase* phase = nullptr;
  int repeat = 0;
  bool is_sweep = false;  ///< its runs are processes of their own: their number is seen, and what they give together
  plan::Facts facts;
  std::vector<int> thread_of;  ///< by block
  double chunk_s = 0.0;
};

/// What can be seen at a moment.
struct Look {
  std::uint64_t generation = 0;  ///< of the phase's run; 0: none has begun
  bool runs = false;
  std::shared_ptr<const PhaseFacts> facts;  ///< null: none has begun
  execute::State state;                     ///< as long as it runs, then the last one; of a sweep the progress alone, in runs
  std::vector<std::vector<ParameterValue>> values;  ///< by block, by parameter: now in effect
  std::vector<std::vector<std::uint64_t>> counts;   ///< by block, by message output: records sent
  std::vector<Record> records;                      ///< of the whole run, in the order in which they first came
  std::vector<Change> changes;                      ///< of the whole run, the last Watch::kMostShown
};

/// Watches a graph while it runs, and takes changes of its live parameters. For any thread. The threads of the run take no part
/// in it: what they give on the way lies in places of its own (Tap), what is looked at are counters that they keep anyway.
class Watch final : public execute::Observer {
 public:
  /// Changes that may wait at a time, that a look shows, and in the whole run.
  static constexpr std::size_t kMostWaiting = 64, kMostShown = 100, kMostChanges = 20'000;

  /// A phase is about to run; the sink that takes the place of `sink` until it has ended.
  execute::Sink& begin_phase(const graph::Phase& phase, int repeat, const plan::Facts& facts, const plan::Plan& plan,
                             execute::Sink& sink);
  void end_phase();
  /// A phase that is a sweep begins; how many runs of how many are done; what they give together.
  void begin_sweep(const graph::Phase& phase, int repeat);
  void sweep_progress(const execute::Progress& runs);
  void add_record(const graph::Phase& phase, graph::End from, const SharedRecord& record);

  void begins(execute::Access& access) override;
  void ends() override;

  Look look();

  /// Asks for a change in the run of a phase that `Look::generation` told; the value is written as in a graph file, and checked
  /// as there. Error: why it is not accepted.
  tl::expected<void, std::string> ask(std::uint64_t generation, const std::string& block, const std::string& parameter,
                                      const std::string& value);

  /// The changes of which it is known since the last call what became of them, in the order in which they were asked for.
  std::vector<Change> news();

 private:
  struct Wish {
    Change change;
    bool told = false;
    execute::Asked asked;
  };

  void settle(Wish& wish, bool ended);
  void collect();
  void collect_records();
  void collect_values();
  void keep(const std::string& key, const Sent& sent);
  double time_of(const Wish& wish) const;

  std::mutex mutex_;
  std::uint64_t generation_ = 0;
  bool runs_ = false;
  std::shared_ptr<const PhaseFacts> facts_;
  std::deque<std::unique_ptr<Tap>> taps_;  ///< of all phases: a thread that hangs may still have one
  execute::Access* access_ = nullptr;
  execute::State state_;
  std::vector<std::vector<ParameterValue>> values_;
  std::vector<std::vector<std::uint64_t>> counts_;
  std::vector<Record> records_;
  std::uint64_t version_ = 0;
  std::deque<Wish> wishes_;  ///< of the whole run, which has their addresses
  std::size_t settled_ = 0;  ///< the first so many of them are not waiting
  std::size_t told_ = 0;     ///< and known to the caller of `news`
};

}  // namespace bodeflow::observe
