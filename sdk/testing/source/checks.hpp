#pragma once

#include <string>
#include <vector>

#include "isolate.hpp"
#include "rig.hpp"

namespace bodeflow::testing {

/// One check of a block in a case. `run` throws Failure where the block is at fault, Skip where the check does not apply.
struct BlockCheck {
  std::string name;
  std::function<void(const Case&, const Step&)> run;
  unsigned timeout_s = 0;       ///< 0: as the options say
  bool hang_is_failure = true;  ///< else it is skipped: with values that a host refuses
};

/// The checks that every case of a block goes through.
std::vector<BlockCheck> case_checks();

/// The checks of a block's parameters: extreme values in their range are taken or refused in a moment, values outside of it,
/// which a host refuses, never crash.
std::vector<BlockCheck> parameter_checks(const bf_block_descriptor& block);

/// The trace of a new instance.
Trace fresh_run(const Case& the_case, const Calls& calls);

}  // namespace bodeflow::testing
