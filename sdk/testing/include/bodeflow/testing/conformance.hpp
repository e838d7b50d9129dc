#pragma once

#include <bodeflow/testing/report.hpp>
#include <bodeflow/testing/settings.hpp>
#include <string>

namespace bodeflow::testing {

struct Options {
  /// Beside the defaults, and in their place for blocks with required parameters.
  Settings settings;
  /// Tests this block alone; empty: all.
  std::string block;
  /// Each check runs in a child process, so that a crash is one failed check. Without: in the calling process (debuggers).
  bool isolate = true;
  /// A check that takes longer fails.
  unsigned timeout_s = 60;
};

/// What a plugin file does against its contract: its note and descriptors, and for each block and setting the life cycle,
/// bit-identity over sizes and boundaries of calls, reset, memory that is left alone, claims (real-time safe, in place), bad
/// samples and parameters, purity of resolve. Runs the plugin's code in child processes of the caller, which has a single
/// thread at that time. The check for allocation, locks and input or output is skipped unless the program links
/// bodeflow::testing_hook.
Report check_plugin(const std::string& file, const Options& options = {});

}  // namespace bodeflow::testing
