#pragma once

#include <string>
#include <vector>

namespace bodeflow::tools {

/// One line of `bodeflow doctor`.
struct Finding {
  std::string what;
  std::string state;  ///< "good", "note" or "bad"
  std::string found;
  std::string advice;  ///< what to do, empty when good
};

/// What this machine has and lacks for runs that keep time: permission of SCHED_FIFO and of locked memory, resolution of the
/// kernel's timers, frequency governor of the processor, isolated cores.
std::vector<Finding> real_time_findings();

/// The same of the files below `root` ("/sys" and "/proc" in it), for tests.
Finding frequency_governor(const std::string& root);
Finding isolated_cores(const std::string& root);

}  // namespace bodeflow::tools
