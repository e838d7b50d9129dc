#pragma once

#include <functional>

#include "plan/plan.hpp"

namespace bodeflow::plan {

/// What a block says to the facts of its inputs: its resolve(), or a stand-in. The error is the block's own text.
using Resolver = std::function<tl::expected<Resolution, std::string>(int block, const std::vector<StreamFacts>& inputs)>;

/// As establish_facts with instances.
tl::expected<Facts, Problems> establish_facts(const graph::Phase& phase, const Resolver& resolver);

/// Facts with ports counted and nothing known, the steps of establish_facts then fill them in turn.
Facts empty_facts(const graph::Phase& phase);

/// The edge that feeds each stream input, -1 where unconnected.
std::vector<std::vector<int>> feeding_edges(const graph::Phase& phase);

/// Resolves every block until nothing changes; stream lengths end with the run and with the shortest input.
Problems resolve_blocks(const graph::Phase& phase, const Resolver& resolver, Facts& facts);

/// Checks the ports of resolved blocks against each other and sets their firing rates.
Problems check_rates(const graph::Phase& phase, Facts& facts);

/// Sets the repetitions and the period of the phase by the balance equations.
Problems balance_phase(const graph::Phase& phase, Facts& facts);

/// Sets the firings until each block's end, and the lengths of all streams; warns of blocks that never fire.
Problems find_ends(const graph::Phase& phase, Facts& facts);

/// Firings until the block ends: by the run's duration, its inputs and the lengths that it states; -1: without end.
std::int64_t firings_of(const graph::Phase& phase, const Facts::Block& block);

/// Firings per second by the first stream port that is known; zero: none.
Rate firing_rate_of(const Facts::Block& block);

}  // namespace bodeflow::plan
