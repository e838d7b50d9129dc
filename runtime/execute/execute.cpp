#include "execute/execute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "execute/access.hpp"
#include "execute/compile.hpp"
#include "execute/crew.hpp"
#include "execute/finish.hpp"
#include "execute/progress.hpp"
#include "execute/scheduling.hpp"
#include "execute/seed.hpp"

namespace bodeflow::execute {
namespace {

using Clock = std::chrono::steady_clock;

Outcome refused(std::string reason) {
  Outcome outcome;
  outcome.status = Outcome::Status::partial;
  outcome.reason = std::move(reason);
  return outcome;
}

/// Activates the instances in order; how many of them, all unless one fails.
std::size_t activate(Run& run, const std::vector<std::unique_ptr<Instance>>& instances) {
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const BlockRun& block = *run.blocks[i];
    const std::int64_t most = std::max<std::int64_t>(1, block.per_repetition * run.chunking.periods);
    bf_activation activation{};
    activation.struct_size = sizeof activation;
    activation.realtime = run.realtime() ? 1 : 0;
    activation.max_count = static_cast<std::uint64_t>(run.options.call_limit > 0 ? std::min(most, run.options.call_limit) : most);
    activation.seed = block_seed(run.options.seed, run.name(static_cast<int>(i)));
    activation.rate = block.has_streams() ? block.rate.c() : bf_rate{0, 1};
    activation.vector_level = run.options.vector_level;
    if (auto done = instances[i]->activate(activation); !done) {
      run.control.fail(static_cast<int>(i), done.error());
      return i;
    }
  }
  return instances.size();
}

/// All threads of the run until their end; false: one hangs. `leave` is called when a run that ends early has no thread in a
/// block any more but those of asynchronous blocks: a device need not wait for what still computes.
bool run_threads(const std::shared_ptr<Run>& run, Crew& crew, const std::function<void()>& leave) {
  for (const auto& worker : run->workers)
    crew.start(worker->lane(), fmt::format("the thread of block '{}'", run->name(worker->block().index)),
               [w = worker.get()] { w->run(); });
  const std::size_t first = crew.size();
  Scheduling scheduling(run->phase->run, [&run](const std::string& text) { run->warn(text); });
  for (const auto& partition : run->partitions)
    scheduling.apply(
        crew.start(partition->lane, fmt::format("thread {}", partition->index + 1), [p = partition.get()] { p->work(); }));
  run->open_gate();
  if (!crew.watch(first)) return false;
  if (run->control.stopping())
    leave();
  else
    crew.start(run->finisher, "the last thread", [r = run.get()] { finish_run(*r); });
  return crew.watch();
}

/// What is known of a block at the end.
BlockMetrics metrics_of(const Run& run, const BlockRun& block) {
  BlockMetrics metrics;
  metrics.calls = block.calls;
  metrics.firings = static_cast<std::uint64_t>(block.position);
  metrics.seconds = block.other_s;
  if (block.timed_firings > 0)
    metrics.seconds += block.timed_s * static_cast<double>(block.position) / static_cast<double>(block.timed_firings);
  for (const Feed& feed : block.feeds) {
    const std::int64_t left =
        run.blocks[static_cast<std::size_t>(feed.block)]->position * feed.produced - block.position * feed.consumed;
    metrics.dropped += static_cast<std::uint64_t>(std::max<std::int64_t>(left, 0));
  }
  return metrics;
}

Outcome outcome_of(const Run& run, bool hung, const std::string& hang) {
  Outcome outcome;
  outcome.wall_s = std::chrono::duration<double>(Clock::now() - run.started).count();
  outcome.overruns = run.overruns.load();
  outcome.skipped = static_cast<std::uint64_t>(run.skipped.load());
  outcome.not_permitted = run.not_permitted;
  outcome.hung = hung;
  outcome.time_s = progress_of(run).time_s;
  outcome.metrics.resize(run.blocks.size());
  if (!hung) {  // a thread that was left behind may still count
    for (std::size_t i = 0; i < run.blocks.size(); ++i) outcome.metrics[i] = metrics_of(run, *run.blocks[i]);
    LatenessCounter lateness;
    for (const auto& partition : run.partitions) lateness.add(partition->lateness);
    outcome.lateness = lateness.summary();
    for (const auto& limiter : run.limiters) outcome.limits.push_back(limiter->record());
  }
  if (!run.control.stopping()) return outcome;
  const Control::End end = run.control.end();
  outcome.status = Outcome::Status::partial;
  outcome.interrupted = end.interrupted;
  outcome.failed_block = end.block;
  outcome.limit = end.limit;
  outcome.reason = end.reason;
  if (end.limit >= 0) {
    const Limiter& limiter = *run.limiters[static_cast<std::size_t>(end.limit)];
    outcome.reason = "limit violated: " + to_text(limiter.limit(), limiter.first()) + "; the run was ended";
  }
  if (hung && end.reason != hang && (end.interrupted || end.block >= 0)) outcome.reason += "; then " + hang;
  return outcome;
}

/// An observer's access to the run, as long as it lives.
class Watched {
 public:
  explicit Watched(Run& run) : access_(run), observer_(run.options.observer) {
    if (observer_ != nullptr) observer_->begins(access_);
  }
  ~Watched() {
    if (observer_ != nullptr) observer_->ends();
  }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

 private:
  Access access_;
  Observer* observer_;
};

Outcome execute_all(const std::shared_ptr<Run>& run, const std::vector<std::unique_ptr<Instance>>& instances,
                    const std::vector<InitialRecord>& initial) {
  if (auto compiled = compile(*run, instances, initial); !compiled) return refused(compiled.error());
  run->started = Clock::now();
  const std::size_t activated = activate(*run, instances);
  bool hung = false;
  std::vector<bool> active(instances.size(), false);
  std::fill_n(active.begin(), activated, true);
  const auto deactivate = [&](std::size_t i) {
    if (active[i]) instances[i]->deactivate();
    active[i] = false;
  };
  const auto leave = [&] {
    for (std::size_t i = 0; i < instances.size(); ++i)
      if (run->blocks[i]->worker < 0) deactivate(i);
  };
  std::string hang;
  if (activated == instances.size()) {
    const Warn warn = [&run](const std::string& text) { run->warn(text); };
    const LockedMemory locked(run->phase->run, warn);
    const AwakeCores awake(run->phase->run, warn);
    run->started = Clock::now();
    run->control.watch(run->gate);
    const Watched watched(*run);
    const Reporter reporter(*run);
    Crew crew(run);
    try {
      hung = !run_threads(run, crew, leave);
    } catch (const std::exception& e) {  // no thread could be made: those that run are ended
      run->control.fail(-1, e.what());
      hung = !crew.watch();
    }
    if (hung) run->control.abandon();
    hang = crew.hang();
    for (const int hanging : crew.disband())
      if (hanging >= 0) active[static_cast<std::size_t>(hanging)] = false;
  }
  for (std::size_t i = 0; i < instances.size(); ++i) deactivate(i);
  run->tell_violations();
  return outcome_of(*run, hung, hang);
}

}  // namespace

Outcome execute(const graph::Phase& phase, const plan::Facts& facts, const plan::Plan& plan,
                const std::vector<std::unique_ptr<Instance>>& instances, const std::vector<InitialRecord>& initial, Sink& sink,
                const Options& options) {
  try {
    auto run = std::make_shared<Run>();
    run->phase = &phase;
    run->facts = &facts;
    run->plan = &plan;
    run->sink = &sink;
    run->options = options;
    return execute_all(run, instances, initial);
  } catch (const std::exception& e) {
    return refused(e.what());
  }
}

}  // namespace bodeflow::execute
