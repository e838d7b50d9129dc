#pragma once

#include "lab/host_parts.hpp"

namespace bodeflow::lab {

/// The phase that runs, as its launcher knows it.
struct RunningPhase {
  const graph::Phase& phase;
  std::size_t index = 0;  ///< in the graph
  int repeat = 0;
  const plan::Facts& facts;
  const std::vector<execute::InitialRecord>& initial;
  std::chrono::steady_clock::time_point started;
};

/// Sends `initial` and lets a part run.
tl::expected<void, std::string> begin_phase(HostPart& part, const std::vector<execute::InitialRecord>& initial,
                                            std::uint64_t seed);

/// Starts the part of a lost host again while the other hosts wait for it: the seconds of the phase at which it goes on. That is
/// the first chunk that neither any host has sent samples of to it, nor has got samples of from it; of a phase that is paced, at
/// the earliest the chunk whose time it is. Error: why the run can't go on.
tl::expected<double, Ended> restart(HostParts& hosts, HostPart& lost, const RunningPhase& running);

}  // namespace bodeflow::lab
