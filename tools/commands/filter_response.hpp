#pragma once

#include <string>
#include <vector>

#include "commands/command.hpp"

namespace bodeflow::tools {

/// A block with settings, at a sample rate: PARAM=VALUE, and a rate with its unit, "10 kHz".
struct ConfiguredBlock {
  std::vector<std::string> sets;
  std::string rate;
  bool json = false;
};

/// Prints the frequency and the impulse response of a filter as it is configured; gives the exit code. Blocks that send the
/// record `filter` can tell them: the block is run for one sample.
int print_filter_response(const Session& session, Registry& registry, const BlockDescription& block,
                          const ConfiguredBlock& configured);

}  // namespace bodeflow::tools
