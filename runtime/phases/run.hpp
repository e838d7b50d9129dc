#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "observe/watch.hpp"
#include "phases/prepare.hpp"
#include "phases/services.hpp"

namespace bodeflow::phases {

/// Changes that were made by hand while a phase of the run that is repeated went on.
struct PastChanges {
  std::string phase;
  int repeat = 0;
  std::vector<execute::PastChange> changes;
};

struct RunOptions {
  PlanSettings plan;
  std::uint32_t vector_level = 1;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string& phase, const execute::Progress&)> progress;
  std::filesystem::path command;         ///< our own executable: the worker processes of a sweep run `command phase-worker ...`
  std::vector<std::string> plugin_path;  ///< their --path
  observe::Watch* watch = nullptr;       ///< sees the run and changes live parameters while it goes on
  std::vector<PastChanges> past_changes;
};

struct RunResult {
  /// unreachable: a host of the lab is not there, or does not fit; device: a device or a block of the network ended the run;
  /// limit: a limit of the graph did.
  enum class Status { complete, rejected, failed, interrupted, unreachable, device, limit };
  Status status = Status::complete;
  std::string phase;  ///< in which it ended
  std::string block;  ///< whose error ended it; may be empty
  std::string reason;
  Problems problems;  ///< rejected: what is wrong with a phase, found when it was its turn
  bool hung = false;  ///< a thread of a block could not be stopped: end the process without clean-up
};

/// A phase that was refused because of `problems`.
RunResult rejection(const graph::Phase& phase, Problems problems);

/// How a run ends by an error of this block.
RunResult::Status failure_of(const graph::Block& block);

/// What the manifest says of a run that ended so.
const char* status_word(RunResult::Status status);

/// The seed of a phase's repetition: each has random numbers of its own. The only phase of a graph keeps the run's seed.
std::uint64_t seed_of(const graph::Phase& phase, int repeat);

/// What a phase says of how it is executed; what the system does not permit goes to `services`, which outlive the run.
execute::Options execution_of(const graph::Phase& phase, const HostServices& services);

/// The records of earlier phases that a phase refers to. Error: which was never sent, with its place.
tl::expected<std::vector<execute::InitialRecord>, Problems> initial_records(const graph::Phase& phase,
                                                                            const record::RunDirectory& directory);

/// Prepares every phase once, so that all problems are known before anything runs.
tl::expected<std::vector<Prepared>, Problems> prepare_all(const graph::Graph& graph, Registry& registry, const Services& services,
                                                          const PlanSettings& settings);

/// Runs one repetition of the phase of that index.
using RunPhase = std::function<RunResult(std::size_t phase, int repeat)>;

/// Runs the phases of a graph in order, each as its conditions want it and as often; the first that is not complete ends it.
/// `warn` is told where `until` was not met.
RunResult run_in_order(const graph::Graph& graph, record::RunDirectory& directory, const RunPhase& run_phase,
                       const std::function<void(const graph::Phase&, const std::string&)>& warn);

/// Runs the phases in order, with conditions, repeats and sweeps, into the directory. `prepared` is used up.
RunResult run(const graph::Graph& graph, std::vector<Prepared> prepared, Registry& registry, record::RunDirectory& directory,
              const Services& services, const RunOptions& options);

}  // namespace bodeflow::phases
