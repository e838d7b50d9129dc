#pragma once

#include <bodeflow/block.hpp>

#include "line_choice.hpp"

namespace bodeflow::generators {

/// Describes `lines` and `detection`.
void describe_lines(Describe& d);

/// The lines named, before detection lines are left out. Fails on what a period cannot hold.
LineNumbers named_lines(const Parameters& p, std::int64_t period);

/// Those of them that are excited.
LineNumbers excited_lines(const Parameters& p, const LineNumbers& named);

/// The amplitudes of the named lines, from `amplitude` or from the curve `spectrum`.
std::vector<double> named_amplitudes(const Parameters& p, const LineNumbers& named, double line_distance_hz);

}  // namespace bodeflow::generators
