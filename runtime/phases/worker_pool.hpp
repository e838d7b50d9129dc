#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bodeflow::phases {

struct PoolResult {
  std::optional<std::size_t> failed;  ///< lowest index of a command that did not exit with 0
  std::string message;                ///< the end of what it said on standard error, or how it ended
  int exit_code = 0;                  ///< of it; 1 when it was ended by a signal
  bool interrupted = false;
};

/// Runs every command (argument vectors) as a child process, as many at a time as there are cores; after a failure no more
/// are started. `done` is told after each end how many have ended.
PoolResult run_processes(const std::vector<std::vector<std::string>>& commands, const std::atomic<bool>* stop,
                         const std::function<void(std::size_t)>& done);

}  // namespace bodeflow::phases
