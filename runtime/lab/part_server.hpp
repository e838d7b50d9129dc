#pragma once

#include <atomic>
#include <filesystem>
#include <memory>

#include "plugins/registry.hpp"
#include "transport/link.hpp"

namespace bodeflow::lab {

/// What a process that runs one host's part of a run is started with.
struct PartTask {
  std::string run;                  ///< name of the run
  std::string host;                 ///< "" : the launcher's own machine
  std::filesystem::path directory;  ///< what the part leaves; created
  transport::Settings settings;
};

/// Serves one run's part until its launcher says goodbye or is lost: makes and resolves its blocks, runs its phases, sends what
/// they left. `stop` ends a phase that runs. The exit code of the process; errors are said on standard error.
int serve_part(const PartTask& task, Registry& registry, const std::atomic<bool>& stop);

}  // namespace bodeflow::lab
