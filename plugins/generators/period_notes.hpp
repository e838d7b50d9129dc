#pragma once

#include <bodeflow/block.hpp>
#include <span>

namespace bodeflow::generators {

/// Periods up to this size are computed while a graph is checked.
inline constexpr std::size_t kNotedPeriod = 1 << 20;

/// Notes the period, the crest factor and the lines of a periodic stream from one period of its samples. Lines below 1e-6 of the
/// strongest count as not excited; more than 100000 lines are left out.
void note_period(StreamFacts& facts, std::span<const double> period);

}  // namespace bodeflow::generators
