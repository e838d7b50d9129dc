#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "execute/block.hpp"
#include "execute/violation.hpp"

namespace bodeflow::execute {

/// One limit while its phase runs: looks at each sample of its channels in turn. Only the thread of the limited block uses it,
/// but for `news`. Takes no memory while running.
class Limiter {
 public:
  explicit Limiter(const plan::Limit& limit);

  /// Sample `position` of the limit's channel `channel` (index into plan::Limit::channels): what may go on in its place, which is
  /// the sample itself unless it is to be held within the limit. An input counts its rate of change from plan::Limit::start, an
  /// output from its first sample. A sample that is not finite is replaced by the last one that was allowed.
  double look(std::size_t channel, double x, std::uint64_t position);
  /// Whether the last sample ends the run; whether it was held within the limit.
  bool stops() const { return violated_now_ && limit_.on_violation == graph::OnViolation::stop; }
  bool holds() const { return violated_now_ && clamps_; }

  const plan::Limit& limit() const { return limit_; }
  LimitRecord record() const;

  /// True once, when the first violation is there: `first` may be read then. One thread.
  bool news();
  const Violation& first() const { return first_; }

 private:
  struct Channel {
    double before = 0.0;  ///< what went on last
    double last = 0.0;    ///< what came last
    bool has_before = false, has_last = false;
  };

  Bound bound_of(const Channel& channel, double x) const;
  double held(const Channel& channel, double x) const;
  void observe(Channel& channel, double x);
  void count(Bound bound, std::size_t channel, double x, std::uint64_t position);

  const plan::Limit& limit_;
  double step_;  ///< greatest change from sample to sample
  bool clamps_;
  std::vector<Channel> channels_;
  bool violated_now_ = false;
  std::uint64_t samples_ = 0, violations_ = 0;
  double lowest_, highest_, steepest_ = 0.0;
  bool any_step_ = false;
  Violation first_;
  std::atomic<bool> violated_{false};
  bool told_ = false;
};

/// Stands between the engine and a block that has limits: looks at its input samples before the block gets them and at its output
/// samples when it has made them, firing by firing, so that a chunk's length changes nothing.
class Guard {
 public:
  /// Takes the place of the block's process function.
  explicit Guard(BlockRun& block);

  void add(Run& run, const graph::Limit& written, Limiter& limiter, int limit);
  /// Index of the limit that ends the run, or -1.
  int stopped() const { return stopped_; }

 private:
  struct Placed {
    Limiter* limiter;
    int limit;
  };
  /// A port with limits. `memory`: where the samples go that a limit has changed; null where none may.
  struct Port {
    std::size_t stream = 0;  ///< index into BlockRun::streams
    std::vector<Placed> limits;
    std::vector<void*> memory;
    bool changed = false;  ///< in this call: the block is shown `memory`
  };

  static std::int32_t process(void* block, bf_process* process);
  std::int32_t process(bf_process& process);
  std::int64_t look(std::vector<Port>& ports, std::int64_t firings);
  bool look_at(Port& port, std::int64_t firing);
  void change(Port& port, const bf_stream& stream, std::uint32_t channel, std::uint64_t sample, double y);
  void show_inputs();
  Port& port_of(std::vector<Port>& ports, std::size_t stream);

  BlockRun& block_;
  std::int32_t (*call_)(void*, bf_process*);
  std::vector<Port> inputs_, outputs_;
  std::vector<bf_stream> shown_;  ///< the block's inputs as it sees them
  int stopped_ = -1;
};

/// Gives each block with limits its guard. Blocks and memory exist.
void guard_limits(Run& run);

}  // namespace bodeflow::execute
