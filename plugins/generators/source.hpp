#pragma once

#include <bodeflow/block.hpp>
#include <string>

#include "hertz.hpp"

/// What the generators have in common: a stream that begins here has a sample rate and a unit of its own.
namespace bodeflow::generators {

inline constexpr double kMaxRateHz = 1e12;

/// Describes the parameters `sample_rate` and `unit`.
void describe_source(Describe& d);

/// The exact sample rate that the graph gives.
Rate source_rate(const Parameters& p);

/// The facts of a source's output.
StreamFacts source_facts(Rate rate, const std::string& unit, int channels = 1, std::int64_t length = -1);

}  // namespace bodeflow::generators
