#pragma once

#include "plan/links.hpp"

namespace bodeflow::plan {

/// How the blocks of a feedback loop take turns; the fields as in Step.
struct LoopSchedule {
  std::vector<Firing> firings;
  std::int64_t repetitions = 1;
  std::int64_t parts = 1;
};

/// The schedule of the strongly connected `blocks`, found by firing blocks as soon as the samples on their edges allow
/// (class-S algorithm: Lee and Messerschmitt, 1987). When each block can make all its firings of several periods at once,
/// so many periods (up to `most` of the phase) make one pass; else one period of the loop does, run-length grouped.
/// A latency L on a message connection lets the consumer run ahead of the producer by L.
/// Errors: a loop that cannot start, with its cycle and what is missing on which edge.
tl::expected<LoopSchedule, Problems> schedule_loop(const graph::Phase& phase, const Facts& facts, const std::vector<int>& blocks,
                                                   const std::vector<Link>& links, std::int64_t most);

}  // namespace bodeflow::plan
