#pragma once

#include "phases/run.hpp"

namespace bodeflow::phases {

/// Runs a phase once for every combination of its sweep's values (the first axis varies slowest), each in a worker process of
/// its own, as many at a time as there are cores; merges the records in that order, so that the result does not depend on
/// which worker ends first. The runs' own directories lie below `sweep/<phase>/<index>`.
RunResult run_sweep(const graph::Phase& phase, const plan::Plan& plan, int repeat, record::RunDirectory& directory,
                    const HostServices& services, const RunOptions& options);

/// The exit code with which a worker says that a device ended its run.
inline constexpr int kDeviceEnded = 5;
/// And that a limit did.
inline constexpr int kLimitEnded = 7;

/// One run of a sweep, in the worker process: what `phase-worker` was asked for.
struct WorkerTask {
  std::string graph_file;
  std::string phase;
  std::vector<std::pair<std::string, std::string>> overrides;
  std::optional<std::uint64_t> seed;
  std::filesystem::path directory;   ///< of this run
  std::filesystem::path references;  ///< folder with the records of earlier phases
};

/// Runs it; the message outputs' last records stand in `directory/records` afterwards.
RunResult run_worker(const WorkerTask& task, Registry& registry, const RunOptions& options);

/// One record of `runs` records of one type: numeric attributes and arrays of equal shape, stacked with the runs as first
/// dimension; `axes` are the swept values. Type "sweep", attributes `of` (their type) and `runs`.
SharedRecord merge_records(const std::vector<SharedRecord>& records, const std::vector<graph::SweepAxis>& axes,
                           const std::vector<std::vector<std::string>>& values);

}  // namespace bodeflow::phases
