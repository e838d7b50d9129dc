#pragma once

#include "plan/plan.hpp"

namespace bodeflow::lab {

/// A connection between blocks on different hosts.
struct Cut {
  std::string from_host, to_host;
  std::string name;  ///< "motor.current -> dft.output"
  bool message = false;
  int edge = 0;  ///< index into the whole phase's streams or messages
  /// The consumer may run ahead of the producer by its delay: the loop through it is stepped in chunks that are not longer.
  bool ahead = false;

  // Streams.
  StreamFacts facts;
  std::uint64_t delay = 0;      ///< samples before the first real one
  std::vector<double> initial;  ///< their values; empty: zeros
  graph::Gaps gaps = graph::Gaps::nan;

  // Records.
  Rate latency;             ///< seconds, between a record's time and its effect
  std::string record_type;  ///< "" : any
};

/// What all hosts of a run agree on about a phase: a value, the same for the same input.
struct Layout {
  std::vector<std::string> hosts;       ///< in the order in which the graph first names them; "" is where the graph was started
  std::vector<std::vector<int>> steps;  ///< components of the whole phase, in one order that all hosts keep
  std::vector<Cut> cuts;
  std::int64_t periods = 1;  ///< of the phase in a chunk, the same on all hosts
  Rate end;                  ///< seconds until the run's end
};

/// How the blocks of `phase` lie on their hosts. Errors: a loop over hosts whose delay is shorter than a period of the phase, by
/// name.
///
/// Every host runs its blocks chunk by chunk in the order of `steps`. A connection between hosts waits for the producer's same
/// chunk, unless its own delay is a chunk or more and it closes a loop: then for an earlier one. So the calls of all hosts have
/// one common order in which each finds its data: no host waits for itself.
tl::expected<Layout, Problems> lay_out(const graph::Phase& phase, const plan::Facts& facts, const plan::PlanOptions& options);

/// One end of a cut in a part: a block of the engine's own.
struct PartEnd {
  int block = 0;  ///< in the part's phase
  int cut = 0;    ///< in Layout::cuts
  bool sends = false;
};

/// What one host runs.
struct Part {
  graph::Phase phase;  ///< its blocks, and one for each end of a cut
  plan::Facts facts;
  plan::PlanOptions options;
  std::vector<PartEnd> ends;
};

/// The part of `host`. Facts and phase are the whole ones.
Part part_of(const graph::Phase& phase, const plan::Facts& facts, const Layout& layout, const std::string& host,
             const plan::PlanOptions& options);

/// Makes of `part`, not run yet, one that begins at `period` of the phase as if that were the first: what its blocks, streams and
/// schedule have before is left out, of a live parameter the last change before is made at the beginning. The end of the run,
/// from there.
Rate begin_part_at(Part& part, const Rate& end, std::int64_t period);

}  // namespace bodeflow::lab
